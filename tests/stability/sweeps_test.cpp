#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <string>
#include <utility>

#include "core/support/check.h"
#include "tests/stability/accuracy_sweep.h"
#include "tests/stability/growth_sweep.h"
#include "tests/stability/long_run.h"
#include "tests/stability/tolerance_sweep.h"
#include "tests/support/name_of.h"

// Runs over a range of requirements or sizes, and long runs.
namespace vat::stability::sweeps_test {
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

INSTANTIATE_TEST_SUITE_P(All, AccuracySweep, testing::ValuesIn(kAccuracyScenes), test::NameOf());

const GrowthFamily& growth_family(const std::string& size) {
  const auto family =
      std::ranges::find_if(growth_families(), [&](const auto& one) { return one.size == size; });
  VAT_CHECK(family != growth_families().end());
  return *family;
}

struct GrowthCase {
  const char* solve;
  int small;
  int large;
  double factor;  ///< maximum ratio of the iterations
};

// Contacts at rest start with the impulses of the preceding step. The two solves of a step then
// need one round of two sweeps each, which is four iterations. A solve needs more if rounding
// errors of previous steps add up to the tolerance. Without these impulses, a wall needs more than
// a hundred.
TEST(GrowthSweep, NeedsFewIterationsForContactsAtRest) {
  for (const auto& [size, values] :
       {std::pair("blocks", std::array{5, 20}), std::pair("rows of bricks", std::array{2, 4})}) {
    for (const int value : values) {
      const GrowthPoint point = measure_growth(growth_family(size), value, 200);
      EXPECT_EQ(point.events, 0U) << value << " " << size;
      EXPECT_GE(point.iterations, 4) << value << " " << size;
      EXPECT_LT(point.iterations, 20) << value << " " << size;
    }
  }
}

// Without preconditioner and extrapolation, the iterations of a chain grow at least in proportion
// to its length, and those of a viscous liquid with the square root of its viscosity.
TEST(GrowthSweep, NeedsFewMoreIterationsForALargeProblem) {
  for (const auto& [solve, small, large, factor] :
       {GrowthCase{"damping", 1000, 10'000, 3.2}, GrowthCase{"implicit springs", 5, 200, 1.5},
        GrowthCase{"limited elongation", 20, 200, 2}}) {
    const auto family = std::ranges::find(growth_families(), std::string(solve),
                                          [](const auto& one) { return std::string(one.name); });
    ASSERT_NE(family, growth_families().end()) << solve;
    const GrowthPoint few = measure_growth(*family, small, 100);
    const GrowthPoint many = measure_growth(*family, large, 100);
    EXPECT_EQ(few.events + many.events, 0U) << solve;
    EXPECT_GT(few.iterations, 0) << solve;
    EXPECT_LT(many.iterations, factor * few.iterations) << solve;
  }
}

class ToleranceSweep : public testing::TestWithParam<const char*> {};

// A tolerance holds at the end of each step; a factor of three covers the forces between. In the
// shallow pools a step at 0.05 % takes hardly more than the one iteration that each step takes. A
// dam break must not gain energy: a quarter of the released one makes the liquid 12 % too fast.
TEST_P(ToleranceSweep, HoldsEveryToleranceWithoutAFailure) {
  const std::string scene = GetParam();
  const bool is_dam_break = scene.ends_with("dam-break");
  std::map<Real, TolerancePoint> points;
  for (const Real tolerance : all_tolerances()) {
    const TolerancePoint point = measure_tolerance(scene, tolerance, 1);
    EXPECT_FALSE(point.failed) << tolerance;
    EXPECT_LT(point.density_error, 3 * tolerance) << tolerance;
    if (is_dam_break) EXPECT_LT(point.energy_gain, 0.25 * point.released) << tolerance;
    points[tolerance] = point;
  }
  if (scene == "dam-break" || scene == "deep-tank") {
    EXPECT_GT(points.at(5e-4).products(), 1.7 * points.at(0.01).products());
  }
  EXPECT_GT(1.05 * points.at(5e-4).products(), points.at(0.1).products());
  EXPECT_GT(1.05 * points.at(0.01).products(), points.at(0.1).products());
  EXPECT_GT(1.05 * points.at(1e-5).products(), points.at(5e-4).products());
}

INSTANTIATE_TEST_SUITE_P(All, ToleranceSweep, testing::ValuesIn(kToleranceScenes), test::NameOf());

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

INSTANTIATE_TEST_SUITE_P(All, LongRun, testing::ValuesIn(long_run_names()), test::NameOf());

}  // namespace
}  // namespace vat::stability::sweeps_test
