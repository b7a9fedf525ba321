#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/json/json_reader.h"

namespace vat::json_reader_parse_test {
namespace {

using testing::HasSubstr;

std::string repeat(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

/// Returns the error's code, or "" if the text is valid.
std::string code_of(const std::string& text, const JsonLimits& limits = {}) {
  const Result<Json> document = parse_json(text, limits);
  if (document) return "";
  EXPECT_EQ(document.errors().size(), 1U);
  EXPECT_EQ(document.errors().front().path, "");
  EXPECT_FALSE(document.errors().front().message.empty());
  return document.errors().front().code;
}

TEST(ParseJson, GivesTheDocument) {
  const Result<Json> document = parse_json(R"( {"a": [1, -2.5, "\u00e9", null, true]} )");
  ASSERT_TRUE(document.ok());
  EXPECT_EQ(document.value().dump(), "{\"a\":[1,-2.5,\"\xc3\xa9\",null,true]}");
}

TEST(ParseJson, RefusesInvalidJson) {
  using namespace std::string_literals;
  const std::vector<std::string> texts[] = {
      {"", " ", "{", "[1,]", "{\"a\":}", "{'a':1}", "nul", "01", "1.", ".5", "+1", "NaN"},
      {"Infinity", "-", "[1 2]", "\"open", "\"tab\there\"", "\"\\x\"", "{\"a\":1,}"},
      {"// c\n1", "{1:2}", "{} {}", "1 x"},
      {"{}\0"s, "{}\0{\"hidden\": 1}"s, "\"a\0b\""s, "\0"s},  // zero bytes
      {"\"\xff\"", "\"\xc3\"", "\"\xc0\xaf\"", "\"\xed\xa0\x80\"", "\"\xf5\x80\x80\x80\"",
       "{\"\x80\":1}", "\xff"},                                   // text that is not UTF-8
      {R"("\ud800")", R"("\udc00")", R"("\ud800\ud800")"},        // lone surrogates
      {"1e400", "[-1e999999999]", "9" + std::string(400, '0')}};  // numbers that are not finite
  for (const std::vector<std::string>& kind : texts) {
    for (const std::string& text : kind) EXPECT_EQ(code_of(text), "parse_error") << text;
  }
  for (const char* text : {"1 \n\t ", R"("\ud83d\ude00")", "1e308", "1e-400"}) {
    EXPECT_EQ(code_of(text), "") << text;  // the last one is rounded to 0, as in every reader
  }
}

TEST(ParseJson, BoundsTheBytes) {
  JsonLimits limits;
  limits.bytes = 10;
  EXPECT_EQ(code_of("\"12345678\"", limits), "");
  EXPECT_EQ(code_of("\"123456789\"", limits), "too_large");
}

TEST(ParseJson, BoundsTheDepth) {
  JsonLimits limits;
  limits.depth = 3;
  EXPECT_EQ(code_of("[[[1]]]", limits), "");
  EXPECT_EQ(code_of("[{\"a\":[1]}]", limits), "");
  EXPECT_EQ(code_of("[[[[]]]]", limits), "too_deep");
  EXPECT_EQ(code_of("[{\"a\":[{}]}]", limits), "too_deep");
  EXPECT_EQ(code_of("[[],[],[],[[]]]", limits), "");  // closed arrays do not count
}

TEST(ParseJson, SurvivesABombOfBrackets) {
  JsonLimits limits;
  limits.bytes = 4 * 1024 * 1024;
  EXPECT_EQ(code_of(repeat("[", 1'000'000), limits), "too_deep");
  EXPECT_EQ(code_of(repeat("{\"a\":", 500'000), limits), "too_deep");
}

TEST(ParseJson, BoundsTheValues) {
  JsonLimits limits;
  limits.values = 4;
  EXPECT_EQ(code_of("[1,true,null]", limits), "");
  EXPECT_EQ(code_of("[1,true,null,\"a\"]", limits), "too_many_values");
  EXPECT_EQ(code_of("[[],[],[],[]]", limits), "too_many_values");
  EXPECT_EQ(code_of("{\"a\":1.5,\"b\":-2,\"c\":{}}", limits), "");
  EXPECT_EQ(code_of("{\"a\":1.5,\"b\":-2,\"c\":{},\"d\":1}", limits), "too_many_values");
}

TEST(ParseJson, RefusesDuplicateKeysOfOneObjectOnly) {
  EXPECT_EQ(code_of(R"({"a":1,"a":1})"), "duplicate_key");
  EXPECT_EQ(code_of(R"({"a":1,"\u0061":2})"), "duplicate_key");
  EXPECT_EQ(code_of(R"([{"x":{"b":1,"b":2}}])"), "duplicate_key");
  EXPECT_EQ(code_of(R"({"a":{"a":1},"b":[{"a":1},{"a":2}]})"), "");
}

TEST(ParseJson, NamesThePlaceOfTheFault) {
  const Result<Json> document = parse_json("{\n \"a\": 1,\n \"b\": oops\n}");
  ASSERT_FALSE(document.ok());
  EXPECT_THAT(document.errors().front().message, HasSubstr("line 3, column 7"));
}

/// The server sends messages to clients as JSON text, which must be UTF-8.
TEST(ParseJson, MessagesAreShortPlainText) {
  const std::string junk = repeat("\xff\x01\x1b[31m", 1000);
  for (const std::string& text : {"\"" + junk, junk, "1" + repeat("0", 5000) + "x"}) {
    const Result<Json> document = parse_json(text);
    ASSERT_FALSE(document.ok());
    const std::string& message = document.errors().front().message;
    EXPECT_LT(message.size(), 200U);
    for (const char c : message) EXPECT_TRUE(c >= ' ' && c <= '~');
  }
}

}  // namespace
}  // namespace vat::json_reader_parse_test
