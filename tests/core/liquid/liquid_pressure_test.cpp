#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::liquid_pressure_test {
namespace {

TEST(TaitPressure, IsTaitsEquationUpToThreePercent) {
  for (const Real s : {0.5, 0.99, 1.0, 1.01, 1.03}) {
    EXPECT_NEAR(tait_pressure(s), (std::pow(s, 7) - 1) / 7, 1e-15) << s;
  }
}

TEST(TaitPressure, IsLinearInTheVolumeBeyond) {
  for (const Real s : {1.0300001, 1.2, 2.0}) {
    EXPECT_NEAR(tait_pressure(s), tait_pressure(1.03) + 0.9 * (1 / 1.03 - 1 / s), 1e-15) << s;
  }
}

TEST(TaitPressure, ContinuesAlongItsTangentFromTwiceTheDensity) {
  for (const Real s : {2.0, 3.0, 10.0}) {
    EXPECT_NEAR(tait_pressure(s), tait_pressure(2) + 0.225 * (s - 2), 1e-15 * s) << s;
  }
}

constexpr Real kDensity = 1000;

Scene make_liquid_scene(const LiquidConstants& constants, ParticleShape shape) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3, {make_liquid("water", kDensity, constants)});
  scene.bodies = {make_body("water", BodyKind::liquid, "water", std::move(shape), 0.5)};
  return scene;
}

TEST(GasPressure, DoesNotPullBelowRestDensity) {
  const std::vector<Vec3> points = {{0, 0, 0}, {0.8, 0, 0}};
  const ForceProbe probe(make_liquid_scene({100, 0, 2}, make_particles(points, 1)));
  EXPECT_EQ(probe.force(0, 0), Vec3::Zero());
  EXPECT_EQ(probe.work().of<LiquidScratch>().pressure[0], 0);
}

// m1 m2 (p1 + p2)/(rho1 rho2) 45/(pi h^6)(h - r)^2, and half of that as printed in the reference.
TEST(GasPressure, OfAPairIsTheFormula) {
  constexpr Real kDistance = 0.6;
  constexpr Real kSupport = 1.3;
  ParticleShape shape = make_particles({{0, 0, 0}, {0, kDistance, 0}}, 1);
  shape.masses = {5000, 8000};
  const Real h9 = std::pow(kSupport, 9);
  const auto poly6 = [&](Real r) {
    return 315 / (64 * std::numbers::pi * h9) * std::pow(kSupport * kSupport - r * r, 3);
  };
  const Real rho_1 = 5000 * poly6(0) + 8000 * poly6(kDistance);
  const Real rho_2 = 8000 * poly6(0) + 5000 * poly6(kDistance);
  const Real pressures = 7 * (rho_1 - kDensity + rho_2 - kDensity);
  const Real expected = 5000 * 8000 * pressures / (rho_1 * rho_2) * 45 /
                        (std::numbers::pi * std::pow(kSupport, 6)) *
                        std::pow(kSupport - kDistance, 2);
  Scene scene = make_liquid_scene({7, 0, kSupport}, shape);
  const ForceProbe probe(scene);
  EXPECT_NEAR(probe.force(0, 1).y() / expected, 1, 1e-13);
  EXPECT_EQ(probe.force(0, 0), Vec3(-probe.force(0, 1)));
  scene.printed_pressure_force = true;
  EXPECT_NEAR(ForceProbe(scene).force(0, 1).y() / expected, 0.5, 1e-13);
}

}  // namespace
}  // namespace vat::test::liquid_pressure_test
