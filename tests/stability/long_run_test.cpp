#include <gtest/gtest.h>

#include <iostream>

#include "tests/stability/long_run.h"

namespace vat::stability::long_run_test {
namespace {

class LongRun : public testing::TestWithParam<std::string> {};

TEST_P(LongRun, StaysWithinItsBounds) {
  for (const LongRunRow& row : run_long(GetParam(), 20000)) {
    std::cout << row.scene << ", " << row.quantity << ": " << row.value << " of " << row.bound
              << " (" << row.reason << ")\n";
    EXPECT_EQ(row.steps, 20000U);
    EXPECT_EQ(row.undone, 0U) << row.quantity;
    EXPECT_LE(row.value, row.bound) << row.quantity;
  }
}

std::string long_run_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) {
    if (c == '-') c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, LongRun, testing::ValuesIn(long_run_names()), long_run_name);

}  // namespace
}  // namespace vat::stability::long_run_test
