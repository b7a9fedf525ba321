// The limits against closed forms and published values, and against what the integrators do.

#include "core/scene/stable_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "tests/support/scenes.h"

namespace vat::stable_step_test {

void PrintTo(IntegratorId integrator, std::ostream* out) {
  *out << to_string(integrator);
}

namespace {

/// Greatest omega dt at a damping ratio of rate = 2 ratio omega.
Real limit(IntegratorId integrator, Real ratio) {
  constexpr Real kOmega = 7;
  return kOmega * stable_step(integrator, {kOmega * kOmega, 2 * ratio * kOmega});
}

TEST(StableStep, OfRungeKuttaMethodsIsThatOfTheirPolynomials) {
  constexpr Real kRatios[] = {0, 0.05, 0.1, 0.5, 1};
  constexpr Real kHeun[] = {0, 0.800, 1.050, 2, 2};
  constexpr Real kRungeKutta4[] = {2 * std::numbers::sqrt2, 2.910, 2.951, 2.622, 2.785};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(limit(IntegratorId::explicit_euler, kRatios[i]), 2 * kRatios[i], 1e-9);
    EXPECT_NEAR(limit(IntegratorId::heun, kRatios[i]), kHeun[i], 1e-3);
    EXPECT_NEAR(limit(IntegratorId::runge_kutta_4, kRatios[i]), kRungeKutta4[i], 1e-3);
  }
}

TEST(StableStep, OfSymplecticEulerFallsWithDamping) {
  for (const Real ratio : {0.0, 0.05, 0.5, 1.0, 3.0}) {
    const Real expected = 2 * (std::sqrt(1 + ratio * ratio) - ratio);
    EXPECT_NEAR(limit(IntegratorId::symplectic_euler, ratio), expected, 1e-9);
  }
}

TEST(StableStep, OfVelocityVerletDoesNotDependOnDamping) {
  for (const Real ratio : {0.0, 0.05, 0.5, 1.0, 3.0}) {
    EXPECT_NEAR(limit(IntegratorId::velocity_verlet, ratio), 2, 1e-9);
  }
}

TEST(StableStep, OfDampingAloneIsThatOfDecay) {
  for (const IntegratorId integrator : test::kIntegrators) {
    const Real decay = integrator == IntegratorId::runge_kutta_4 ? 2.785 : 2;
    if (integrator == IntegratorId::velocity_verlet) {
      EXPECT_TRUE(std::isinf(stable_step(integrator, {0, 10})));
    } else {
      EXPECT_NEAR(stable_step(integrator, {0, 10}), decay / 10, 1e-3 / 10);
    }
    EXPECT_TRUE(std::isinf(stable_step(integrator, {0, 0})));
  }
}

/// The greatest distance from rest of a mass of 1 kg on a spring after 4000 steps, begun at 1e-6 m.
/// It grows without end beyond the limit; the guard stops a step at its latest.
Real final_amplitude(IntegratorId integrator, const Oscillation& oscillation, Real dt) {
  Scene scene = test::make_scene(integrator, dt);
  scene.materials = {test::make_material("m")};
  ParticleShape shape = test::make_particles({{0, 0, 0}, {1 + 1e-6, 0, 0}}, 1);
  shape.fixed = {0};
  scene.bodies = {test::make_body("mass", BodyKind::deformable, "m", shape, 0.1)};
  scene.bodies[0].springs = {{0, 1, {oscillation.omega2, oscillation.rate}, 1.0}};
  Simulation simulation = test::make_simulation(scene);
  Real greatest = 0;
  for (int step = 0; step < 4000; ++step) {
    if (!simulation.advance(1).events.empty()) return 1;
    const Real distance = std::abs(test::position_of(simulation, 0, 1).x() - 1);
    if (step >= 3900) greatest = std::max(greatest, distance);
  }
  return greatest;
}

class StableStepOf : public testing::TestWithParam<IntegratorId> {};

TEST_P(StableStepOf, IsWhereASimulationBeginsToGrow) {
  constexpr Real kOmega = 100;
  for (const Real ratio : {0.0, 0.1, 0.5, 1.5}) {
    const Oscillation oscillation{kOmega * kOmega, 2 * ratio * kOmega};
    const Real step = stable_step(GetParam(), oscillation);
    if (step == 0) continue;
    EXPECT_LT(final_amplitude(GetParam(), oscillation, 0.98 * step), 1e-5) << ratio;
    EXPECT_GT(final_amplitude(GetParam(), oscillation, 1.1 * step), 1e-4) << ratio;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, StableStepOf, testing::ValuesIn(test::kIntegrators));

}  // namespace
}  // namespace vat::stable_step_test
