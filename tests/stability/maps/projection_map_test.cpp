#include "tests/stability/maps/projection_map.h"

#include <gtest/gtest.h>

namespace vat::stability::projection_map_test {
namespace {

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
}  // namespace vat::stability::projection_map_test
