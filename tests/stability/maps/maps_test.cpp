#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "tests/stability/maps/projection_map.h"
#include "tests/stability/maps/step_map.h"
#include "tests/support/scenes.h"

namespace vat::stability::maps_test {
namespace {

// The start contains other modes besides the fastest one. A short run may therefore pass slightly
// above the limit, but it must not fail below it.
TEST(StepMap, ReachesTheoryOnLinearCases) {
  for (const LinearCase& linear : linear_cases(true)) {
    for (const IntegratorId integrator : test::kIntegrators) {
      if (std::isinf(theoretical_step(linear, integrator))) continue;
      const StepMapPoint point = map_point(linear, integrator);
      SCOPED_TRACE(linear.body + ", " + to_string(integrator) + ", damping ratio " +
                   std::to_string(linear.damping_ratio) + ", mass ratio " +
                   std::to_string(linear.mass_ratio));
      EXPECT_GE(point.measured, 0.95 * point.theory);
      // For liquids, theory gives a bound.
      EXPECT_LE(point.measured, (linear.scene.periodic ? 1.5 : 1.1) * point.theory);
    }
  }
}

TEST(StepMap, HasNoLimitForImplicitSprings) {
  for (const LinearCase& linear : implicit_cases(true)) {
    const StepMapPoint point = map_point_without_limit(linear, IntegratorId::velocity_verlet);
    EXPECT_GT(point.frequency * kMaxStep, 999);
    EXPECT_EQ(point.measured, kMaxStep) << linear.body << ", damping ratio " << linear.damping_ratio
                                        << ", frequency " << point.frequency;
  }
}

TEST(ProjectionMap, IsStableAtAnyStepAndMassRatio) {
  for (const ProjectionPoint& point : projection_points(true)) {
    const ProjectionPoint seen = measure_projection(point);
    EXPECT_TRUE(is_stable(seen)) << to_string(seen.integrator) << ", mass ratio " << seen.mass_ratio
                                 << ", step " << seen.step << ": gain " << seen.energy_gain
                                 << ", overlap " << seen.overlap << ", kinetic energy "
                                 << seen.kinetic_energy << ", guarded " << seen.is_guarded;
  }
}

}  // namespace
}  // namespace vat::stability::maps_test
