#include <gtest/gtest.h>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Adaptive steps of weakly compressible liquids on an OpenCL device.

namespace vat::device_adaptive_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

/// A column of water that is narrower than its vat, so that it collapses. Without displacements
/// from the lattice, the first forces would be rounding errors, and so would the rate of motion.
Scene make_column() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.02);
  scene.numerics.control = StepControl::adaptive;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {25, 0.01, 2 * kSpacing})};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.12}, {0.16, 0.12, 0.24}}, kSpacing}};
  scene.bodies[0].jitter = 0.1;
  return scene;
}

/// The column without a vat, with weak forces, and with a tolerance that no motion exceeds.
Scene make_drop() {
  Scene scene = make_column();
  scene.vat.reset();
  scene.gravity = {0, 0, -0.1};
  scene.numerics.tolerance = 1;
  return scene;
}

// Both compute sums over pairs in single precision, with the same steps.
TEST(AdaptiveDevice, HasTheAccuracyOfTheCpu) {
  constexpr std::uint32_t kSteps = 4;
  expect_accuracy_of_cpu(make_column(), kCommonScenes, kSteps);
}

// Each scene has another limit of its steps.
TEST(AdaptiveDevice, ChoosesTheStepsOfTheCpu) {
  const SceneCase cases[] = {
      {"travel of all particles",
       [](Scene& scene) {
         scene.bodies[0].velocity = {8, -5, 4};
       }},
      {"travel of particles relative to the mean",
       [](Scene& scene) {
         scene.bodies.push_back(scene.bodies[0]);
         scene.bodies[1].name = "other";
         scene.bodies[1].position = {0, 0, 0.4};
         scene.bodies[0].velocity = {0, 0, -8};
         scene.bodies[1].velocity = {0, 0, 8};
       }},
      {"acceleration",
       [](Scene& scene) {
         scene.gravity = {0, 0, -200};
       }},
      {"rate of motion", [](Scene& scene) { scene.numerics.tolerance = 1e-5; }},
  };
  expect_adaptive_steps_of_cpu(make_column(), 4);
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_drop();
    one.edit(scene);
    expect_adaptive_steps_of_cpu(scene, 2);
  }
}

TEST(AdaptiveDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_column(), 1);
}

TEST(AdaptiveDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_column(), 4, 1e-3 * kSpacing);
}

// A command makes the forces unknown. The step control then has no accelerations, and the step
// begins with an evaluation.
TEST(AdaptiveDevice, ContinuesAfterACommandWithTheStepsOfTheCpu) {
  Simulation device = make_on_device(make_column());
  Simulation cpu = make_simulation(make_column());
  for (Simulation* one : {&device, &cpu}) {
    one->advance(2);
    ASSERT_TRUE(one->set_gravity({200, 0, -100}).ok());
  }
  const AdvanceReport report = device.advance(2);
  const AdvanceReport expected = cpu.advance(2);
  EXPECT_EQ(report.device_steps, 2U);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_EQ(report.force_evaluations, expected.force_evaluations);
  EXPECT_NEAR(report.least_step, expected.least_step, 1e-12);
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(AdaptiveDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Simulation simulation = make_on_device(make_column());
  EXPECT_EQ(simulation.advance(12).device_steps, 12U);
  EXPECT_EQ(simulation.state_hash(), 0x7f786740707d05cdU);
}

TEST(AdaptiveDevice, RestoresTheStateBeforeAFailedStep) {
  Scene scene = make_drop();
  // The integer positions of the device end at 64 support radii, 2.2 m above the drop.
  scene.bodies[0].velocity = {0, 0, 19};
  expect_restored_state(scene, 4, 2);
}

}  // namespace
}  // namespace vat::device_adaptive_test
