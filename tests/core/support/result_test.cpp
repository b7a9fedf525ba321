#include "core/support/result.h"

#include <gtest/gtest.h>

namespace vat::result_test {
namespace {

const Error kError{"out_of_range", "/bodies/0/radius", "must be above 0"};

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
