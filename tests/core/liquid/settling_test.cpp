#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace vat::test::settling_test {
namespace {

/// One liquid particle without neighbours that moves at 2 m/s along y.
Scene make_lone_drop(Real step, const Settling& settling) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("water", 1000, {100, 0, 0.1})};
  scene.bodies = {
      make_body("drop", BodyKind::liquid, "water", make_particles({{0, 0, 0}}, 0.1), 0.05)};
  scene.bodies[0].velocity = {0, 2, 0};
  scene.settling = settling;
  return scene;
}

TEST(Settling, IsADragUntilItsTime) {
  constexpr Real kDrag = 3;
  Simulation simulation = make_simulation(make_lone_drop(1e-3, {kDrag, 0.5}));
  advance_to(simulation, 0.5);
  const Real expected = 2 * std::exp(-kDrag * 0.5);
  // The last half kick of the 500 steps has no drag.
  EXPECT_NEAR(simulation.bodies()[0].velocities[0].y(), expected, expected * kDrag * 1e-3);
  const Vec3 kept = simulation.bodies()[0].velocities[0];
  advance_to(simulation, 1);
  EXPECT_EQ(simulation.bodies()[0].velocities[0], kept);
}

TEST(Settling, IsStableAtAnyStrength) {
  Simulation simulation = make_simulation(make_lone_drop(1e-3, {1e6, 0.5}));
  EXPECT_TRUE(simulation.advance(10).events.empty());
  // Velocity Verlet with implicit damping at the end of the step is the trapezoidal rule.
  const Real expected = 2 * std::pow((1 - 500.0) / (1 + 500.0), 10);
  EXPECT_NEAR(simulation.bodies()[0].velocities[0].y(), expected, 0.01 * expected);
}

TEST(Settling, IsTowardsTheVelocityOfTheVat) {
  Scene scene = make_lone_drop(1e-3, {1e3, 0.5});
  scene.vat = Vat{{-1, -1, -1}, {1, 1, 1}, false, SlideMotion{{1, 0, 0}, 0.1, 1}};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 0.25);
  const Real expected = 0.1 / 2 * 2 * M_PI;  // the maximum, after a quarter of the period
  EXPECT_NEAR(simulation.bodies()[0].velocities[0].x(), expected, 0.01 * expected);
  EXPECT_NEAR(simulation.bodies()[0].velocities[0].y(), 0, 1e-6);
}

}  // namespace
}  // namespace vat::test::settling_test
