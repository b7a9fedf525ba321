#include "tests/stability/accuracy_sweep.h"

#include <gtest/gtest.h>

namespace vat::stability::accuracy_sweep_test {
namespace {

class AccuracySweep : public testing::TestWithParam<const char*> {};

// The accuracy is the relative error of phase and amplitude after 100 radians. Adaptive control of
// scenes with contacts keeps the same error per radian.
TEST_P(AccuracySweep, HoldsEveryAccuracyAndCostsLessForALargerOne) {
  std::uint64_t last_work = ~std::uint64_t{0};
  for (const Real accuracy : all_accuracies()) {
    const AccuracyPoint point = measure_accuracy(GetParam(), accuracy);
    EXPECT_FALSE(point.failed) << accuracy;
    EXPECT_LT(point.error, accuracy);
    EXPECT_LE(static_cast<double>(point.work()), 1.05 * static_cast<double>(last_work)) << accuracy;
    last_work = point.work();
  }
}

INSTANTIATE_TEST_SUITE_P(All, AccuracySweep, testing::ValuesIn(kAccuracyScenes),
                         [](const testing::TestParamInfo<const char*>& one) {
                           std::string name = one.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace vat::stability::accuracy_sweep_test
