#include "core/scene/pair_precision.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"

// The accuracy of single precision, and the cases that need double precision.

namespace vat::test::pair_precision_test {
namespace {

/// A mixture, and a copy of one of its liquid blocks at `distance`.
Scene make_spread_mixture(PairPrecision precision, Real distance) {
  Scene scene = make_wet_mixture(IntegratorId::velocity_verlet, PressureSolver::tait);
  scene.pair_precision = precision;
  BodyDescription stray = scene.bodies.front();
  stray.name = "stray";
  stray.position += Vec3(distance, 0, 0);
  scene.bodies.push_back(stray);
  return scene;
}

Real greatest_support(const ForceProbe& probe) {
  Real support = 0;
  for (const auto& liquid : probe.model().liquids) {
    if (liquid) support = std::max(support, liquid->support_radius);
  }
  return support;
}

/// Returns the largest difference between forces in single and double precision, relative to the
/// largest force.
Real relative_difference(Real distance) {
  const ForceProbe a(make_spread_mixture(PairPrecision::single_precision, distance));
  const ForceProbe b(make_spread_mixture(PairPrecision::double_precision, distance));
  Real greatest = 0;
  Real difference = 0;
  for (std::size_t i = 0; i < a.model().free_count; ++i) {
    greatest = std::max(greatest, b.state().forces.particle[i].norm());
    difference =
        std::max(difference, (a.state().forces.particle[i] - b.state().forces.particle[i]).norm());
  }
  return difference / greatest;
}

TEST(PairPrecision, IsSingleOverAThousandSupports) {
  const Real support = greatest_support(ForceProbe(make_spread_mixture({}, 1)));
  // Rounded positions change densities by 1e-7 to 1e-6. The forces result from compressions of at
  // least a thousandth.
  EXPECT_GT(relative_difference(1), 0);
  EXPECT_LT(relative_difference(1), 1e-4);
  EXPECT_GT(relative_difference(900 * support), 0);
  EXPECT_LT(relative_difference(900 * support), 1e-3);
}

TEST(PairPrecision, IsDoubleForDistantParticles) {
  const Real support = greatest_support(ForceProbe(make_spread_mixture({}, 1)));
  EXPECT_EQ(relative_difference(1100 * support), 0);
  EXPECT_EQ(relative_difference(1e5 * support), 0);
}

}  // namespace
}  // namespace vat::test::pair_precision_test
