#include "server/script/pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vat::script::pattern_test {
namespace {

using testing::HasSubstr;

/// Returns the reason of a mismatch, or "" for a match.
std::string reason(const char* pattern, const char* value, Captures captures = {}) {
  return mismatch(Json::parse(pattern), Json::parse(value), captures).value_or("");
}

bool matches(const char* pattern, const char* value) {
  return reason(pattern, value).empty();
}

TEST(Pattern, PlainValuesMustBeEqual) {
  EXPECT_TRUE(matches("1", "1"));
  EXPECT_TRUE(matches("1", "1.0"));
  EXPECT_TRUE(matches(R"("x")", R"("x")"));
  EXPECT_TRUE(matches("null", "null"));
  EXPECT_FALSE(matches("1", "2"));
  EXPECT_FALSE(matches("1", "\"1\""));
  EXPECT_FALSE(matches("0", "false"));
  EXPECT_FALSE(matches("null", "0"));
}

TEST(Pattern, ObjectsMayHaveMoreMembers) {
  EXPECT_TRUE(matches(R"({"a": 1})", R"({"a": 1, "b": 2})"));
  EXPECT_TRUE(matches("{}", R"({"a": 1})"));
  EXPECT_FALSE(matches(R"({"a": 1})", R"({"b": 1})"));
  EXPECT_FALSE(matches("{}", "[]"));
  EXPECT_FALSE(matches(R"({"a": {"b": 1}})", R"({"a": {"b": 2}})"));
  EXPECT_TRUE(matches(R"({"a": {"$absent": true}})", R"({"b": 1})"));
  EXPECT_FALSE(matches(R"({"a": {"$absent": true}})", R"({"a": null})"));
}

TEST(Pattern, ListsHaveTheSameLength) {
  EXPECT_TRUE(matches("[1, [2]]", "[1, [2]]"));
  EXPECT_FALSE(matches("[1]", "[1, 2]"));
  EXPECT_FALSE(matches("[1, 2]", "[1]"));
  EXPECT_FALSE(matches("[1, 2]", "[2, 1]"));
  EXPECT_FALSE(matches("[]", "{}"));
}

TEST(Pattern, Comparisons) {
  EXPECT_TRUE(matches(R"({"$ge": 2})", "2"));
  EXPECT_FALSE(matches(R"({"$gt": 2})", "2"));
  EXPECT_TRUE(matches(R"({"$le": 2, "$gt": 1})", "1.5"));
  EXPECT_FALSE(matches(R"({"$le": 2, "$gt": 1})", "1"));
  EXPECT_FALSE(matches(R"({"$lt": 2})", "2"));
  EXPECT_FALSE(matches(R"({"$ge": 2})", R"("3")"));
  EXPECT_TRUE(matches(R"({"$near": [1, 0.1]})", "1.05"));
  EXPECT_FALSE(matches(R"({"$near": [1, 0.1]})", "1.2"));
  EXPECT_FALSE(matches(R"({"$near": [1, 0.1]})", "null"));
  EXPECT_TRUE(matches(R"({"$ne": 1})", "2"));
  EXPECT_FALSE(matches(R"({"$ne": 1})", "1"));
}

TEST(Pattern, ToleranceOfEachNumberInAList) {
  EXPECT_TRUE(matches(R"({"$near": [[1, 2], 0.1]})", "[1.05, 1.95]"));
  EXPECT_FALSE(matches(R"({"$near": [[1, 2], 0.1]})", "[1.05, 1.85]"));
  EXPECT_FALSE(matches(R"({"$near": [[1, 2], 0.1]})", "[1]"));
  EXPECT_FALSE(matches(R"({"$near": [[1, 2], 0.1]})", "1"));
  EXPECT_THROW(reason(R"({"$near": ["x", 0.1]})", "1"), ScriptError);
}

TEST(Pattern, OrientationsWithinAnAngle) {
  // A rotation about z by 0.2 rad, from its half angle.
  const char* turned = "[0.995004165278, 0, 0, 0.0998334166468]";
  EXPECT_TRUE(matches(R"({"$turned": [[1, 0, 0, 0], 0.2001]})", turned));
  EXPECT_FALSE(matches(R"({"$turned": [[1, 0, 0, 0], 0.1999]})", turned));
  EXPECT_TRUE(matches(R"({"$turned": [[-1, 0, 0, 0], 0.2001]})", turned));  // the same orientation
  EXPECT_TRUE(matches(R"({"$turned": [[2, 0, 0, 0], 1e-9]})", "[-0.5, 0, 0, 0]"));
  EXPECT_FALSE(matches(R"({"$turned": [[1, 0, 0, 0], 4]})", "[0, 0, 0]"));
  EXPECT_FALSE(matches(R"({"$turned": [[1, 0, 0, 0], 4]})", "[0, 0, 0, 0]"));
  EXPECT_THROW(reason(R"({"$turned": [[1, 0, 0], 0.1]})", turned), ScriptError);
}

TEST(Pattern, TestsOfTextsAndLists) {
  EXPECT_TRUE(matches(R"({"$contains": "bc"})", R"("abcd")"));
  EXPECT_FALSE(matches(R"({"$contains": "x"})", R"("abcd")"));
  EXPECT_FALSE(matches(R"({"$contains": "1"})", "1"));
  EXPECT_TRUE(matches(R"({"$size": 2})", "[1, 2]"));
  EXPECT_TRUE(matches(R"({"$size": 2})", R"("ab")"));
  EXPECT_FALSE(matches(R"({"$size": 2})", "[1]"));
  EXPECT_FALSE(matches(R"({"$size": 1})", R"({"a": 1})"));
  EXPECT_TRUE(matches(R"({"$type": "number"})", "1"));
  EXPECT_FALSE(matches(R"({"$type": "number"})", "[]"));
  EXPECT_TRUE(matches(R"({"$has": {"a": 2}})", R"([{"a": 1}, {"a": 2, "b": 0}])"));
  EXPECT_FALSE(matches(R"({"$has": {"a": 3}})", R"([{"a": 1}, {"a": 2}])"));
  EXPECT_FALSE(matches(R"({"$has": 1})", "1"));
  EXPECT_TRUE(matches(R"({"$each": {"$ge": 0}})", "[0, 1]"));
  EXPECT_FALSE(matches(R"({"$each": {"$ge": 0}})", "[0, -1]"));
}

TEST(Pattern, ACaptureIsReplacedWhereTheTestsBesideItHold) {
  Captures captures{{"$t", 5}};
  const Json next = Json::parse(R"({"$capture": "$t", "$eq": {"$add": ["$t", 1]}})");
  EXPECT_TRUE(mismatch(next, 7, captures));
  EXPECT_EQ(captures.at("$t"), 5);
  EXPECT_FALSE(mismatch(next, 6, captures));
  EXPECT_EQ(captures.at("$t"), 6);
}

TEST(Pattern, ANameCapturesOnceAndComparesAfterThat) {
  Captures captures;
  EXPECT_FALSE(mismatch(Json::parse(R"(["$t", "$t", "$any", "$any"])"), {5, 5, 1, 2}, captures));
  EXPECT_EQ(captures.at("$t"), 5);
  EXPECT_EQ(captures.count("$any"), 0U);
  EXPECT_TRUE(mismatch("$t", 6, captures));
  EXPECT_FALSE(mismatch(Json::parse(R"({"$gt": "$t"})"), 6, captures));
  EXPECT_FALSE(mismatch(Json::parse(R"({"$eq": {"$add": ["$t", 2]}})"), 7, captures));
  EXPECT_FALSE(mismatch(Json::parse(R"({"$capture": "$t"})"), 9, captures));
  EXPECT_EQ(captures.at("$t"), 9);
}

TEST(Pattern, AMismatchCapturesNothing) {
  Captures captures;
  EXPECT_TRUE(mismatch(Json::parse(R"(["$t", 1])"), {5, 2}, captures));
  EXPECT_TRUE(captures.empty());
  EXPECT_FALSE(mismatch(Json::parse(R"({"$has": ["$t", 1]})"), {{5, 2}, {6, 1}}, captures));
  EXPECT_EQ(captures.at("$t"), 6);
}

TEST(Pattern, TheReasonNamesThePlaceAndBothSides) {
  const std::string text = reason(R"({"a": [1, {"$ge": 3}]})", R"({"a": [1, 2]})");
  EXPECT_EQ(text, "at /a/1\n  expected {\"$ge\":3}\n  came     2");
  EXPECT_THAT(reason("1", "[2]"), HasSubstr("at the top\n  expected 1\n  came     [2]"));
  EXPECT_THAT(reason(R"("$t")", "2", {{"$t", 1}}), HasSubstr("expected $t = 1\n  came     2"));
  EXPECT_THAT(reason(R"({"a": 1})", "{}"), HasSubstr("a member \"a\""));
}

TEST(Pattern, MistakesInThePatternAreNotMismatches) {
  EXPECT_THROW(reason(R"({"$about": 1})", "1"), ScriptError);
  EXPECT_THROW(reason(R"({"$gt": "$unknown"})", "1"), ScriptError);
}

TEST(Substitute, ReplacesCapturesSumsAndTexts) {
  const Captures captures{{"$t", 3}, {"$s", "x"}};
  EXPECT_EQ(substitute(Json::parse(R"({"a": ["$t", {"$add": ["$t", 0.5]}], "b": "$s"})"), captures),
            Json::parse(R"({"a": [3, 3.5], "b": "x"})"));
  EXPECT_EQ(substitute(Json::parse(R"({"$repeat": ["ab", 3]})"), captures), "ababab");
  EXPECT_EQ(substitute(Json::parse(R"({"$join": ["c", "$t", "$s"]})"), captures), "c3x");
  EXPECT_THROW(substitute("$unknown", captures), ScriptError);
  EXPECT_THROW(substitute(Json::parse(R"({"$add": [1]})"), captures), ScriptError);
}

}  // namespace
}  // namespace vat::script::pattern_test
