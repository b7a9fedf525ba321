#include <gtest/gtest.h>

#include "tests/support/scenes.h"

// Solids in a weakly compressible liquid, near walls.

namespace vat::liquid_solids_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;
constexpr Real kHalf = 0.16;  // half of the tank's length

BodyDescription make_ball(const char* name, Real x) {
  BodyDescription ball{name, BodyKind::rigid, "wood", SphereShape{Vec3::Zero(), 0.04}, kSpacing};
  ball.position = {x, 0.08, 0.05};
  ball.velocity = {x > 0 ? -0.2 : 0.2, 0.05, 0};
  return ball;
}

/// The liquid of a tank from `low` to kHalf along x, without the volume of a ball at +-0.05 m.
BodyDescription make_water(Real low) {
  std::vector<Vec3> points;
  for (Real x = low + kSpacing / 2; x < kHalf; x += kSpacing) {
    for (Real y = kSpacing / 2; y < kHalf; y += kSpacing) {
      for (Real z = kSpacing / 2; z < 0.1; z += kSpacing) {
        const Vec3 from_ball = Vec3(std::abs(x), y, z) - Vec3(0.05, 0.08, 0.05);
        if (from_ball.norm() > 0.051) points.push_back({x, y, z});
      }
    }
  }
  return make_body("water", BodyKind::liquid, "water",
                   make_particles(points, 1000 * kSpacing * kSpacing * kSpacing), kSpacing / 2);
}

Scene make_tank(Real low) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 5e-4);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.gravity = {0, 0, -9.81};
  scene.default_interface = {0, 0};
  scene.materials = {make_liquid("water", 1000, {100, 0, 2.5 * kSpacing}), make_material("wood")};
  scene.materials[0].liquid->artificial_viscosity = 0;  // the liquid slips along walls
  scene.vat = Vat{{low, 0, 0}, {kHalf, kHalf, 0.4}, false, {}};
  scene.bodies = {make_water(low), make_ball("right", 0.05)};
  return scene;
}

// A vat wall mirrors liquid and solids. Half a tank with a wall in the middle behaves like a
// symmetric tank.
TEST(LiquidSolids, MoveAtAWallAsBesideTheirMirrorImages) {
  Scene whole = make_tank(-kHalf);
  whole.bodies.push_back(make_ball("left", -0.05));
  Simulation both = make_simulation(whole);
  Simulation half = make_simulation(make_tank(0));
  both.advance(60);
  half.advance(60);
  const Vec3 moved = position_of(half, 1) - Vec3(0.05, 0.08, 0.05);
  EXPECT_GT(moved.norm(), 1e-3);
  EXPECT_LT((position_of(half, 1) - position_of(both, 1)).norm(), 1e-10);
  const auto forces = [](const Simulation& of) { return of.diagnostics().bodies[1].outer_force; };
  EXPECT_GT(std::abs(forces(half).x()), 0.1);
  EXPECT_LT((forces(half) - forces(both)).norm(), 1e-8);
}

}  // namespace
}  // namespace vat::liquid_solids_test
