#include "core/support/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace vat::result_test {
namespace {

const Error kError{"out_of_range", "/bodies/0/radius", "must be above 0"};

TEST(Result, HoldsAValue) {
  Result<int> result = 3;
  EXPECT_TRUE(result.ok());
  EXPECT_TRUE(result);
  EXPECT_EQ(result.value(), 3);
  result.value() = 4;
  EXPECT_EQ(result.value(), 4);
}

TEST(Result, GivesAwayAValueThatCannotBeCopied) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(5);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 5);
}

TEST(Result, HoldsOneOrManyErrors) {
  const Result<int> one = kError;
  EXPECT_FALSE(one);
  ASSERT_EQ(one.errors().size(), 1U);
  EXPECT_EQ(one.errors()[0].path, "/bodies/0/radius");
  const Result<int> many = Errors{kError, kError};
  EXPECT_EQ(many.errors().size(), 2U);
}

TEST(Result, StatusIsFineUntilItHasAnError) {
  EXPECT_TRUE(Status().ok());
  EXPECT_TRUE(Status().errors().empty());
  EXPECT_TRUE(Status(Errors{}).ok());
  const Status failed = kError;
  EXPECT_FALSE(failed);
  EXPECT_EQ(failed.errors()[0].code, "out_of_range");
}

TEST(ResultDeathTest, WrongUseIsAnErrorOfTheProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(static_cast<void>(Result<int>(kError).value()), "ok\\(\\)");
  EXPECT_DEATH(static_cast<void>(Result<int>(3).errors()), "ok\\(\\)");
  EXPECT_DEATH(static_cast<void>(Result<int>(Errors{})), "empty");
}

}  // namespace
}  // namespace vat::result_test
