#include "core/stepping/control/step_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/limits.h"
#include "core/numerics/error_model.h"
#include "core/stepping/control/step_control_liquid.h"
#include "tests/support/scenes.h"

namespace vat::test::step_control_test {
namespace {

TEST(StepLevel, IsTheLeastThatIsShortEnough) {
  EXPECT_EQ(level_of(1, 1), 0U);
  EXPECT_EQ(level_of(100, 1), 0U);
  EXPECT_EQ(level_of(0.999, 1), 1U);
  EXPECT_EQ(level_of(0.5, 1), 1U);
  EXPECT_EQ(level_of(0.3, 1), 2U);
  EXPECT_EQ(level_of(0, 1), static_cast<std::uint32_t>(kMaxStepLevel));
  EXPECT_EQ(level_of(std::nan(""), 1), 0U);  // the guard handles such states
}

TEST(StepCount, IsTheLeastThatIsShortEnough) {
  const auto count = [](Real wanted, Real left) {
    StepHistory history;
    return choose_step_count(wanted, left, 1, history);
  };
  EXPECT_EQ(count(1, 1), 1U);
  EXPECT_EQ(count(100, 1), 1U);
  EXPECT_EQ(count(0.999, 1), 2U);
  EXPECT_EQ(count(Real{1} / 3, 1), 3U);
  EXPECT_EQ(count(0.3, 1), 4U);
  EXPECT_EQ(count(0.3, 0.5), 2U);
  EXPECT_EQ(count(0, 1), 1U << kMaxStepLevel);
  EXPECT_EQ(count(0, 0.25), 1U << (kMaxStepLevel - 2));
  EXPECT_EQ(count(std::nan(""), 1), 1U);  // the guard handles such states
}

TEST(StepCount, StepsShortenAtOnceAndLengthenSlowly) {
  StepHistory history;
  EXPECT_EQ(choose_step_count(0.125, 1, 1, history), 8U);
  EXPECT_EQ(choose_step_count(0.0625, 0.875, 1, history), 14U);
  std::vector<Real> steps;
  for (Real left = 1; left > 1e-12; left -= steps.back()) {
    choose_step_count(1, left, 1, history);
    EXPECT_LE(history.step, steps.empty() ? 0.0625 : 2 * steps.back() + 1e-12);
    steps.push_back(history.step);
    ++history.held;
  }
  const std::vector<Real> expected{1. / 16, 1. / 16, 1. / 16, 1. / 16, 1. / 8,
                                   1. / 8,  1. / 8,  1. / 8,  1. / 4};
  ASSERT_EQ(steps.size(), expected.size());
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(steps[i], expected[i], 1e-12) << i;
}

// Each integrator solves x'' = -x. The error model gives the phase of a step for a given error.
TEST(LastingPressure, IsExceededByOneInHundredParticles) {
  std::mt19937 generator(5);
  std::vector<Real> highest;
  EXPECT_EQ(lasting_pressure({}, highest), 0);
  for (const std::size_t count : {1U, 2U, 100U, 101U, 102U, 999U, 5000U}) {
    std::vector<Real> pressures;
    for (std::size_t n = 0; n < count; ++n) {
      pressures.push_back(static_cast<Real>(generator() % (count / 2 + 1)));
    }
    const Real lasting = lasting_pressure(pressures, highest);
    std::ranges::sort(pressures);
    EXPECT_EQ(lasting, pressures[count - 1 - (count - 1) / 100]) << count;
  }
}

TEST(ErrorModel, StepsOfItsPhaseMakeItsError) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const Real error : {1e-2, 1e-3, 1e-4}) {
      const Real z = resolving_phase(integrator, error);
      const Real omega = z / 1e-2;
      Simulation simulation =
          make_simulation(make_oscillator(integrator, 1e-2, {omega * omega, 0}, 1.1));
      const int steps = static_cast<int>(std::lround(2 / z));
      simulation.advance(static_cast<std::uint32_t>(steps));
      const Real angle = steps * z;
      const Real x = (position_of(simulation, 0, 1).x() - 1) / 0.1;
      const Real v = velocity_of(simulation, 0, 1).x() / (0.1 * omega);
      const Real found = std::hypot(x - std::cos(angle), v + std::sin(angle)) / angle;
      // Velocity Verlet's ellipse adds z^2/8, and the next order in z adds more.
      const Real ellipse = integrator == IntegratorId::velocity_verlet ? 3 / angle : 0;
      EXPECT_LT(found, (1.3 + ellipse) * error) << to_string(integrator) << ' ' << error;
      EXPECT_GT(found, 0.2 * error) << to_string(integrator) << ' ' << error;
    }
  }
}

}  // namespace
}  // namespace vat::test::step_control_test
