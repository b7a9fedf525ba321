// Step limits, compared with closed forms and published values. stability/StepMap compares them
// with simulations.

#include "core/numerics/stable_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

namespace vat::test::stable_step_test {

namespace {

/// Returns the largest stable omega dt at a damping rate of 2 ratio omega.
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
  for (const IntegratorId integrator : kIntegrators) {
    const Real decay = integrator == IntegratorId::runge_kutta_4 ? 2.785 : 2;
    if (integrator == IntegratorId::velocity_verlet) {
      EXPECT_TRUE(std::isinf(stable_step(integrator, {0, 10})));
    } else {
      EXPECT_NEAR(stable_step(integrator, {0, 10}), decay / 10, 1e-3 / 10);
    }
    EXPECT_TRUE(std::isinf(stable_step(integrator, {0, 0})));
  }
}

}  // namespace
}  // namespace vat::test::stable_step_test
