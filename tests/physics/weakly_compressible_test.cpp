#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/mixed_scenes.h"
#include "tests/support/same_bits.h"
#include "tests/support/totals.h"

// The weakly compressible liquid: what it keeps, and how well it stands.

namespace vat::weakly_compressible_test {
namespace {

using namespace test;

constexpr Real kGravity = 9.81;

/// A column in the plane, `layers` high over 0.5 m and 0.3 m wide, at rest density.
Scene make_column(int layers) {
  constexpr Real kHeight = 0.5;
  constexpr Real kWidth = 0.3;
  const Real spacing = kHeight / layers;
  const Real sound2 = 100 * kGravity * kHeight;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3 * 20 / layers);
  scene.dimensions = 2;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -kGravity};
  scene.materials = {make_liquid("water", 1000, {sound2, 100, 2 * spacing})};
  scene.vat = Vat{{0, -1, 0}, {kWidth, 1, 1}, false, {}};
  scene.bodies = {BodyDescription{"water", BodyKind::liquid, "water",
                                  BoxShape{{kWidth / 2, 0, kHeight / 2}, {kWidth, 1, kHeight}},
                                  spacing}};
  return scene;
}

struct Standing {
  Real pressure_error = 0;  ///< relative, in the norm of L2
  Real slope = 0;           ///< of the pressure between 0.1 and 0.8 of the height, over -rho g
  Real speed = 0;           ///< greatest, over sqrt(g H)
};

/// LIQ-3 with Tait's equation: (rho/rho_0)^6 = 1 + 6 g (H - z) / c^2 up to the height H.
Standing stand(int layers) {
  const Scene scene = make_column(layers);
  Simulation simulation = make_simulation(scene);
  simulation.advance(static_cast<std::uint32_t>(std::lround(3 / scene.numerics.step)));
  const Real sound2 = scene.materials[0].liquid->stiffness;
  const Real height = 0.497635;  // of the column that weighs as much as 0.5 m at rest density
  const BodyView water = simulation.bodies()[0];
  const LiquidFields fields = simulation.liquid_fields(water.id).value();
  Standing result;
  Real error = 0;
  Real norm = 0;
  Real n = 0;
  Real z1 = 0;
  Real z2 = 0;
  Real p1 = 0;
  Real zp = 0;
  for (std::size_t i = 0; i < water.positions.size(); ++i) {
    const Real z = water.positions[i].z();
    const Real p = fields.pressure[i];
    const Real base = std::max<Real>(1, 1 + 6 * kGravity * (height - z) / sound2);
    const Real expected = 1000 * sound2 / 7 * (std::pow(base, 7.0 / 6) - 1);
    error += (p - expected) * (p - expected);
    norm += expected * expected;
    result.speed = std::max(result.speed, water.velocities[i].norm() / std::sqrt(kGravity * 0.5));
    if (z < 0.1 * height || z > 0.8 * height) continue;
    n += 1;
    z1 += z;
    z2 += z * z;
    p1 += p;
    zp += z * p;
  }
  result.pressure_error = std::sqrt(error / norm);
  result.slope = (n * zp - z1 * p1) / (n * z2 - z1 * z1) / (-1000 * kGravity);
  return result;
}

// LIQ-3: what good solvers reach with 20 layers, and better with 40.
TEST(WeaklyCompressible, ColumnStandsWithTheRightPressure) {
  const Standing coarse = stand(20);
  EXPECT_LT(coarse.pressure_error, 0.03);
  EXPECT_NEAR(coarse.slope, 1, 0.01);
  EXPECT_LT(coarse.speed, 4e-3);
  const Standing fine = stand(40);
  EXPECT_LT(fine.pressure_error, 0.7 * coarse.pressure_error);
  EXPECT_NEAR(fine.slope, 1, 0.005);
  EXPECT_LT(fine.speed, 4e-3);
}

Scene make_mixture() {
  return make_wet_mixture(IntegratorId::velocity_verlet, PressureSolver::tait);
}

// All pairs are central and opposite, so momentum is kept to round-off.
TEST(WeaklyCompressible, KeepsTheMomentumOfLiquidsAndSolids) {
  Simulation simulation = make_simulation(make_mixture());
  const Totals before = totals_of(simulation.diagnostics());
  const Motion size = motion_of(simulation);
  std::vector<Real> greatest(4, 0);
  for (int n = 0; n < 40; ++n) {
    simulation.advance(10);
    const Diagnostics now = simulation.diagnostics();
    for (std::size_t b = 0; b < 4; ++b) {
      greatest[b] = std::max(greatest[b], now.bodies[b].outer_force.norm());
    }
  }
  const Totals after = totals_of(simulation.diagnostics());
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * size.momentum);
  EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(),
            1e-10 * size.angular_momentum);
  EXPECT_THAT(greatest, testing::Each(testing::Gt(1))) << "of outer forces [N]";
}

TEST(WeaklyCompressible, GivesTheSameBitsForAnyThreadsAndFromASnapshot) {
  Scene scene = make_mixture();
  scene.gravity = {0, 0, -kGravity};
  scene.vat =
      Vat{Vec3(-0.15, -0.15, -0.15), Vec3(0.5, 0.4, 1), false, SlideMotion{{1, 0, 0}, 0.2, 2}};
  expect_same_bits(scene, 20, 10);
  scene.numerics.control = StepControl::adaptive;
  expect_same_bits(scene, 20, 10);
}

// LIQ-9a: nothing but the liquid; c = 10 times the greatest speed.
TEST(WeaklyCompressible, DropIsDrawnOutAsByTheory) {
  constexpr Real kTime = 0.0076;
  constexpr Real kSpacing = 0.04;
  Scene scene = make_scene(IntegratorId::velocity_verlet, kTime / 400);
  scene.dimensions = 2;
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("water", 1000, {1400 * 1400, 0, 3 * kSpacing})};
  scene.bodies = {
      BodyDescription{"drop", BodyKind::liquid, "water", SphereShape{Vec3::Zero(), 1}, kSpacing}};
  VectorField field;
  field.gradient = Vec3(-100, 0, 100).asDiagonal();
  scene.bodies[0].velocity_field = field;
  Simulation simulation = make_simulation(scene);
  const auto spread = [&] {
    Real sum = 0;
    const BodyView drop = simulation.bodies()[0];
    for (const Vec3& p : drop.positions) sum += p.z() * p.z();
    return std::sqrt(sum);
  };
  const Real before = spread();
  const Real energy = simulation.diagnostics().kinetic_energy;
  simulation.advance(400);
  EXPECT_NEAR(spread() / before, 1.944517191, 0.002 * 1.944517191);
  EXPECT_LT(simulation.diagnostics().kinetic_energy, energy);
  EXPECT_GT(simulation.diagnostics().kinetic_energy, 0.96 * energy);
}

/// A particle alone in a closed vat of 1 m, without gravity.
Scene make_lone_particle(const Vec3& velocity) {
  constexpr Real kSpacing = 0.1;
  constexpr Real kSound = 10;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.7 * 2 * kSpacing / kSound);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.gravity.setZero();
  scene.materials = {make_liquid("water", 1000, {kSound * kSound, 0, 2 * kSpacing})};
  scene.vat = Vat{{0, 0, 0}, {1, 1, 1}, true, {}};
  scene.bodies = {make_body("drop", BodyKind::liquid, "water",
                            make_particles({{0.5, 0.5, 0.5}}, 1000 * std::pow(kSpacing, 3)),
                            kSpacing / 2)};
  scene.bodies[0].velocity = velocity;
  return scene;
}

// Its images alone do not push it, so that it bounces as at a face, in any phase of its steps.
TEST(WeaklyCompressible, ParticleLeavesEdgesAndCornersAsFastAsItCame) {
  for (const Vec3& direction :
       {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, -0.9, 0.02), Vec3(1, 1, 1), Vec3(-0.9, 1, 0.95)}) {
    for (const Real speed : {0.2, 0.5, 1.0, 2.0}) {
      const Vec3 velocity = speed * direction.normalized();
      Simulation simulation = make_simulation(make_lone_particle(velocity));
      const AdvanceReport report = simulation.advance(500);
      EXPECT_EQ(report.undone_steps, 0);
      EXPECT_NEAR(simulation.bodies()[0].velocities[0].norm(), speed, 1e-12);
    }
  }
}

}  // namespace
}  // namespace vat::weakly_compressible_test
