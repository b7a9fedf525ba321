#include "core/step/step_control.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "core/scene/error_model.h"
#include "tests/support/scenes.h"

namespace vat {
namespace {

using namespace test;

TEST(StepLevel, IsTheLeastThatIsShortEnough) {
  EXPECT_EQ(level_of(1, 1), 0U);
  EXPECT_EQ(level_of(100, 1), 0U);
  EXPECT_EQ(level_of(0.999, 1), 1U);
  EXPECT_EQ(level_of(0.5, 1), 1U);
  EXPECT_EQ(level_of(0.3, 1), 2U);
  EXPECT_EQ(level_of(0, 1), static_cast<std::uint32_t>(kMaxStepLevel));
  EXPECT_EQ(level_of(std::nan(""), 1), 0U);  // the guard deals with such states
}

TEST(StepLevel, RisesAtOnceAndFallsSlowlyAtAlignedPlaces) {
  constexpr std::uint32_t kParts = 1U << kMaxStepLevel;
  StepHistory history;
  choose_level(3, 0, history);
  EXPECT_EQ(history.level, 3U);
  std::uint32_t steps_at_level[4] = {};
  std::uint32_t position = 0;
  while (history.level > 0) {
    choose_level(0, position, history);
    const std::uint32_t step = kParts >> history.level;
    EXPECT_EQ(position % step, 0U);
    if (history.level > 0) ++steps_at_level[history.level];
    position += step;
    ++history.held;
  }
  EXPECT_EQ(steps_at_level[3], kHeldSteps);
  EXPECT_EQ(steps_at_level[2], kHeldSteps);
  EXPECT_EQ(steps_at_level[1], kHeldSteps + 1);  // after four it is in the middle of a whole step
}

// Each integrator, on x'' = -x with steps of the phase that the model gives for an error.
TEST(ErrorModel, StepsOfItsPhaseMakeItsError) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const Real error : {1e-2, 1e-3, 1e-4}) {
      const Real z = resolving_phase(integrator, error);
      Scene scene = make_scene(integrator, 1e-2);
      scene.materials = {make_material("m")};
      const Real omega = z / 1e-2;
      BodyDescription body = make_body("oscillator", BodyKind::deformable, "m",
                                       make_particles({{0, 0, 0}, {1.1, 0, 0}}, 1), 0.01);
      body.springs = {{0, 1, {omega * omega, 0}, 1.0}};
      std::get<ParticleShape>(body.shape).fixed = {0};
      scene.bodies = {body};
      Simulation simulation = make_simulation(scene);
      const int steps = static_cast<int>(std::lround(2 / z));
      simulation.advance(static_cast<std::uint32_t>(steps));
      const Real angle = steps * z;
      const Real x = (position_of(simulation, 0, 1).x() - 1) / 0.1;
      const Real v = velocity_of(simulation, 0, 1).x() / (0.1 * omega);
      const Real found = std::hypot(x - std::cos(angle), v + std::sin(angle)) / angle;
      // Velocity Verlet's ellipse, z^2/8, comes on top; and so does the next order in z.
      const Real ellipse = integrator == IntegratorId::velocity_verlet ? 3 / angle : 0;
      EXPECT_LT(found, (1.3 + ellipse) * error) << to_string(integrator) << ' ' << error;
      EXPECT_GT(found, 0.2 * error) << to_string(integrator) << ' ' << error;
    }
  }
}

}  // namespace
}  // namespace vat
