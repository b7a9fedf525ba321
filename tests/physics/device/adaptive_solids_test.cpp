#include <gtest/gtest.h>

#include "tests/physics/device/on_device.h"
#include "tests/physics/device/pool.h"

// Adaptive steps of liquids with rigid bodies on an OpenCL device.

namespace vat::device_adaptive_solids_test {
namespace {

using namespace test;

/// The pool with steps that step control chooses.
Scene make_adaptive_pool() {
  Scene scene = make_pool(PressureSolver::incompressible);
  scene.numerics.step = scene.numerics.tick = 0.02;
  scene.numerics.control = StepControl::adaptive;
  scene.materials[0].liquid->viscosity = 0;
  return scene;
}

const SceneCase kScenes[] = {
    {"ball", [](Scene&) {}},
    {"hard balls in contact in a sliding vat",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.default_interface = {3000, 0.5, 0.3};
       scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
     }},
    {"ball that hits a wall",
     [](Scene& scene) {
       scene.default_interface = {3000, 0.5};
       scene.bodies[1].velocity = {-1, 0, 0};
     }},
    {"ball that spins",
     [](Scene& scene) {
       scene.bodies[1].angular_velocity = {50, 100, 0};
     }},
    {"balls with contacts by projection",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.default_interface.law = InterfaceLaw::projection;
     }},
    {"ball that is released, and a piston",
     [](Scene& scene) {
       add_piston(scene);
       scene.bodies[1].release = 2 * scene.numerics.step;
       scene.bodies[1].velocity.setZero();
       scene.bodies[1].angular_velocity.setZero();
     }},
    {"ball that moves before its release, and a piston that rotates",
     [](Scene& scene) {
       add_rotating_piston(scene);
       scene.bodies[1].release = 2 * scene.numerics.step;
     }},
    {"fixed ball that moves",
     [](Scene& scene) {
       add_fixed_mover(scene, {-0.5, 0, 0}, {0, 20, 5});
     }},
    {"ball in two dimensions", set_plane},
};

TEST(AdaptiveSolidsDevice, ChoosesTheStepsOfTheCpu) {
  for (const SceneCase& one : kScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_adaptive_pool();
    one.edit(scene);
    expect_adaptive_steps_of_cpu(scene, 4);
  }
}

// The probe of the first step finds the viscous force between the ball and a drop around it.
TEST(AdaptiveSolidsDevice, ProbesTheFirstStep) {
  Scene scene = make_adaptive_pool();
  scene.vat.reset();
  scene.forces.gravity = false;
  scene.numerics.step = scene.numerics.tick = 0.004;
  scene.numerics.tolerance = 1e-7;
  scene.materials[0].liquid->viscosity = 0.1;
  scene.materials[1].density = 50;
  scene.bodies[1].position = {0.08, 0.06, 0.195};
  scene.bodies[1].velocity = {0.5, 0, 0};
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(1);
  const AdvanceReport expected = cpu.advance(1);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_NEAR(report.least_step, expected.least_step, 1e-9);
  EXPECT_LT(report.least_step, report.greatest_step / 1.5);
}

TEST(AdaptiveSolidsDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_adaptive_pool(), 1);
}

TEST(AdaptiveSolidsDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_adaptive_pool(), 2, 1e-2 * kPoolSpacing);
}

TEST(AdaptiveSolidsDevice, RestoresTheStateBeforeAFailedStep) {
  Scene scene = make_adaptive_pool();
  // The integer positions of the device end at 64 support radii.
  scene.bodies[1].position.z() = 64 * 2 * kPoolSpacing - 0.23;
  scene.bodies[1].velocity = {0, 0, 5};
  scene.bodies[1].angular_velocity.setZero();
  expect_restored_state(scene, 1, 2);
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(AdaptiveSolidsDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Scene scene = make_adaptive_pool();
  add_other_ball(scene);
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(3).device_steps, 3U);
  EXPECT_EQ(device.state_hash(), 0xb783257ec92fd73bU);
}

}  // namespace
}  // namespace vat::device_adaptive_solids_test
