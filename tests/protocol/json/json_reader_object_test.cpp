#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/json/json_reader.h"

namespace vat::json_reader_object_test {
namespace {

using testing::HasSubstr;

/// Reads `text` as an object and stores the errors.
class ObjectReaderTest : public testing::Test {
 protected:
  ObjectReader& read(const std::string& text) {
    errors.clear();
    document = Json::parse(text);
    reader.emplace(document, "/at", errors);
    return *reader;
  }
  /// Returns "code path" of the only error; "" if there is none.
  std::string error() const {
    EXPECT_LE(errors.size(), 1U);
    return errors.empty() ? "" : errors[0].code + ' ' + errors[0].path;
  }

  Json document;
  Errors errors;
  std::optional<ObjectReader> reader;
};

TEST_F(ObjectReaderTest, ReadsRealsInRange) {
  EXPECT_EQ(read(R"({"x": 0.1})").real("x", 0, 1), 0.1);
  EXPECT_EQ(read(R"({"x": 1})").real("x", 0, 1), 1);
  EXPECT_EQ(read(R"({"x": 0})").real("x", 0, 1), 0);
  EXPECT_EQ(read(R"({"x": -3})").real("x", -3, 1), -3);
  EXPECT_EQ(read(R"({"x": 18446744073709551615})").real("x", 0, kAnyMax), 18446744073709551615.0);
  EXPECT_EQ(error(), "");
}

TEST_F(ObjectReaderTest, RefusesRealsOutOfRange) {
  for (const char* text :
       {R"({"x": 1.0000000000000002})", R"({"x": -5e-324})", R"({"x": 1e300})"}) {
    EXPECT_EQ(read(text).real("x", 0, 1, 0.5), 0.5) << text;
    EXPECT_EQ(error(), "out_of_range /at/x") << text;
    EXPECT_THAT(errors[0].message, HasSubstr("from 0 to 1"));
  }
}

TEST_F(ObjectReaderTest, RefusesNumbersThatAreNotFinite) {
  Errors found;
  EXPECT_FALSE(to_real(Json(INFINITY), "/x", kAnyMin, kAnyMax, found));
  EXPECT_FALSE(to_real(Json(std::nan("")), "/x", kAnyMin, kAnyMax, found));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].code, "out_of_range");
  EXPECT_EQ(found[1].message, "must be a finite number");
}

TEST_F(ObjectReaderTest, RefusesOtherTypesAsNumbers) {
  for (const char* value : {"true", "false", "null", "\"1\"", "[1]", "{}"}) {
    const std::string text = "{\"x\": " + std::string(value) + "}";
    read(text).real("x", 0, 1);
    EXPECT_EQ(error(), "wrong_type /at/x") << text;
    read(text).count("x", 0, 1);
    EXPECT_EQ(error(), "wrong_type /at/x") << text;
  }
}

TEST_F(ObjectReaderTest, ReadsCounts) {
  EXPECT_EQ(read(R"({"n": 7})").count("n", 0, 7), 7U);
  EXPECT_EQ(read(R"({"n": 7.0})").count("n", 0, 7), 7U);
  EXPECT_EQ(read(R"({"n": 1e3})").count("n", 0, 1000), 1000U);
  EXPECT_EQ(read(R"({"n": 18446744073709551615})").count("n", 0, UINT64_MAX), UINT64_MAX);
  EXPECT_EQ(error(), "");
}

TEST_F(ObjectReaderTest, RefusesValuesOtherThanCounts) {
  for (const char* value : {"-1", "2.9", "8", "1", "-0.5", "1e300", "3000000000",
                            "18446744073709551616", "9007199254740994.0"}) {
    EXPECT_EQ(read("{\"n\": " + std::string(value) + "}").count("n", 2, 7), 2U) << value;
    EXPECT_EQ(error(), "out_of_range /at/n") << value;
    EXPECT_THAT(errors[0].message, HasSubstr("from 2 to 7"));
  }
}

TEST_F(ObjectReaderTest, MissingMembersAreErrorsWithoutAFallback) {
  read("{}").real("x", 2, 3);
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").count("x", 0, 1);
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").boolean("x");
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").text("x", 10);
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").vector("x", 0, 1);
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").choice("x", {"a"});
  EXPECT_EQ(error(), "missing /at/x");
  read("{}").array("x", 3, true);
  EXPECT_EQ(error(), "missing /at/x");
}

TEST_F(ObjectReaderTest, FallbacksStandInForMissingMembers) {
  ObjectReader& empty = read("{}");
  EXPECT_EQ(empty.real("x", 0, 1, 0.25), 0.25);
  EXPECT_EQ(empty.count("x", 0, 9, 4), 4U);
  EXPECT_TRUE(empty.boolean("x", true));
  EXPECT_EQ(empty.text("x", 5, "abc"), "abc");
  EXPECT_EQ(empty.vector("x", 0, 9, Vec3(1, 2, 3)), Vec3(1, 2, 3));
  EXPECT_EQ(empty.choice("x", {"a", "b"}, 1), 1U);
  EXPECT_EQ(empty.array("x", 3), nullptr);
  EXPECT_EQ(error(), "");
}

TEST_F(ObjectReaderTest, ValuesStandingInForErrorsAreInRange) {
  EXPECT_EQ(read("{}").real("x", 2, 3), 2);
  EXPECT_EQ(read("{}").real("x", -3, -2), -2);
  EXPECT_EQ(read("{}").count("x", 5, 9), 5U);
  EXPECT_EQ(read("{}").vector("x", 1, 2), Vec3(1, 1, 1));
}

TEST_F(ObjectReaderTest, ReadsBooleans) {
  EXPECT_TRUE(read(R"({"b": true})").boolean("b"));
  EXPECT_FALSE(read(R"({"b": false})").boolean("b", true));
  EXPECT_EQ(error(), "");
  EXPECT_TRUE(read(R"({"b": 0})").boolean("b", true));
  EXPECT_EQ(error(), "wrong_type /at/b");
}

TEST_F(ObjectReaderTest, BoundsTexts) {
  EXPECT_EQ(read(R"({"t": "abcd"})").text("t", 4), "abcd");
  EXPECT_EQ(error(), "");
  read(R"({"t": "abcde"})").text("t", 4);
  EXPECT_EQ(error(), "out_of_range /at/t");
  read(R"({"t": "\u00e9\u00e9"})").text("t", 3);  // four bytes
  EXPECT_EQ(error(), "out_of_range /at/t");
  read(R"({"t": 4})").text("t", 4);
  EXPECT_EQ(error(), "wrong_type /at/t");
}

TEST_F(ObjectReaderTest, RefusesControlCharactersInTexts) {
  for (const char* value : {"a\\u0000", "\\n", "\\u001b[31m", "\\u007f"}) {
    read("{\"t\": \"" + std::string(value) + "\"}").text("t", 40);
    EXPECT_EQ(error(), "bad_text /at/t") << value;
  }
  EXPECT_EQ(read(R"({"t": " \u00e9~"})").text("t", 40), " \xc3\xa9~");
  EXPECT_EQ(error(), "");
}

TEST_F(ObjectReaderTest, ReadsVectors) {
  EXPECT_EQ(read(R"({"v": [1, -2.5, 0]})").vector("v", -3, 3), Vec3(1, -2.5, 0));
  EXPECT_EQ(error(), "");
  for (const char* value : {"[1, 2]", "[1, 2, 3, 4]", "1", "{\"x\": 1}", "null", "[]"}) {
    read("{\"v\": " + std::string(value) + "}").vector("v", -3, 3);
    EXPECT_EQ(error(), "wrong_type /at/v") << value;
  }
  const Vec3 fallback(1, 1, 1);
  EXPECT_EQ(read(R"({"v": [0, 9, "a"]})").vector("v", -3, 3, fallback), fallback);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].path, "/at/v/1");
  EXPECT_EQ(errors[1].path, "/at/v/2");
}

TEST_F(ObjectReaderTest, ReadsChoices) {
  EXPECT_EQ(read(R"({"c": "b"})").choice("c", {"a", "b"}), 1U);
  EXPECT_EQ(error(), "");
  EXPECT_EQ(read(R"({"c": "other"})").choice("c", {"a", "b"}, 1), 1U);
  EXPECT_EQ(error(), "unknown_name /at/c");
  EXPECT_EQ(errors[0].message, R"(must be one of "a", "b")");
  read(R"({"c": 1})").choice("c", {"a", "b"});
  EXPECT_EQ(error(), "wrong_type /at/c");
}

TEST_F(ObjectReaderTest, BoundsArrays) {
  const Json* array = read(R"({"l": [1, 2]})").array("l", 2);
  ASSERT_NE(array, nullptr);
  EXPECT_EQ(array->size(), 2U);
  EXPECT_EQ(error(), "");
  EXPECT_EQ(read(R"({"l": [1, 2, 3]})").array("l", 2), nullptr);
  EXPECT_EQ(error(), "out_of_range /at/l");
  EXPECT_EQ(read(R"({"l": {"0": 1}})").array("l", 2), nullptr);
  EXPECT_EQ(error(), "wrong_type /at/l");
}

TEST_F(ObjectReaderTest, RefusesMembersThatWereNotRead) {
  ObjectReader& asked = read(R"({"a": 1, "b": 2, "c/d~e": 3})");
  asked.real("a", 0, 9);
  asked.member("absent");
  asked.refuse_unknown();
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].path, "/at/b");
  EXPECT_EQ(errors[1].path, "/at/c~1d~0e");
  EXPECT_EQ(errors[1].code, "unknown_member");
}

TEST_F(ObjectReaderTest, SuggestsMembersThatAreNotGiven) {
  ObjectReader& asked = read(R"({"radus": 1, "mas": 2, "mass": 3, "colour": 4})");
  for (const char* name : {"radius", "mass", "name"}) asked.member(name);
  asked.refuse_unknown();
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(errors[0].suggestion, "");
  EXPECT_EQ(errors[1].suggestion, "") << "mass is given";
  EXPECT_EQ(errors[2].suggestion, "radius");
  EXPECT_EQ(errors[2].message, "is not a known member; did you mean \"radius\"?");
}

TEST_F(ObjectReaderTest, SuggestsNamesOfAnEnumeration) {
  read(R"({"kind": "riged"})").choice("kind", {"liquid", "rigid"});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].suggestion, "rigid");
}

TEST_F(ObjectReaderTest, AValueThatIsNoObjectIsOneError) {
  for (const char* text : {"[]", "null", "3", "\"x\""}) {
    ObjectReader& wrong = read(text);
    EXPECT_FALSE(wrong.has("a"));
    wrong.real("a", 0, 1);
    wrong.text("b", 3);
    wrong.refuse_unknown();
    EXPECT_EQ(error(), "wrong_type /at") << text;
  }
}

TEST_F(ObjectReaderTest, ErrorsAreBounded) {
  Json many = Json::object();
  for (int i = 0; i < 1000; ++i) many["k" + std::to_string(i)] = i;
  ObjectReader(many, "", errors).refuse_unknown();
  EXPECT_EQ(errors.size(), kMaxReadErrors);
}

}  // namespace
}  // namespace vat::json_reader_object_test
