#include "tests/stability/tolerance_sweep.h"

#include <gtest/gtest.h>

#include <map>
#include <ostream>

namespace vat::stability::tolerance_sweep_test {
namespace {

struct SweepCase {
  const char* scene;
  bool gains;  ///< whether 1 % must cost less than 0.05 % by a factor of 1.7
};

void PrintTo(const SweepCase& one, std::ostream* out) {
  *out << one.scene;
}

class ToleranceSweep : public testing::TestWithParam<SweepCase> {};

// A tolerance holds at the end of each step; a factor of three covers the forces between. In the
// shallow pools a step at 0.05 % takes hardly more than the one iteration that each step takes.
TEST_P(ToleranceSweep, HoldsEveryToleranceWithoutAFailure) {
  const auto [scene, gains] = GetParam();
  std::map<Real, TolerancePoint> points;
  for (const Real tolerance : all_tolerances()) {
    const TolerancePoint point = measure_tolerance(scene, tolerance, 1);
    EXPECT_FALSE(point.failed) << tolerance;
    EXPECT_LT(point.density_error, 3 * tolerance) << tolerance;
    points[tolerance] = point;
  }
  if (gains) {
    EXPECT_GT(points.at(5e-4).products(), 1.7 * points.at(0.01).products());
  }
  EXPECT_GT(1.05 * points.at(5e-4).products(), points.at(0.1).products());
  EXPECT_GT(1.05 * points.at(0.01).products(), points.at(0.1).products());
  EXPECT_GT(1.05 * points.at(1e-5).products(), points.at(5e-4).products());
}

INSTANTIATE_TEST_SUITE_P(All, ToleranceSweep,
                         testing::Values(SweepCase{"dam-break", true}, SweepCase{"deep-tank", true},
                                         SweepCase{"buoyancy", false},
                                         SweepCase{"sloshing-tank", false}),
                         [](const testing::TestParamInfo<SweepCase>& one) {
                           std::string name = one.param.scene;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace vat::stability::tolerance_sweep_test
