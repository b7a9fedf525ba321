#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/heap.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Rigid bodies on an OpenCL device.

namespace vat::device_rigid_test {
namespace {

using namespace test;

/// Puts the first body on an axle with a brake.
void put_on_axle(Scene& scene) {
  scene.default_interface.friction = 0.4;
  BodyDescription& body = scene.bodies[0];
  body.velocity.setZero();
  body.axle = Axle{{0.6, 0, 0.8}, 0.002};
  body.angular_velocity = 5 * body.axle->direction;
}

const SceneCase kScenes[] = {
    {"unchanged", [](Scene&) {}},
    {"friction", [](Scene& scene) { scene.default_interface.friction = 0.4; }},
    {"friction on a moving floor in a sliding vat",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.vat->walls[4].velocity = {1, 0.5, 0};
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0.5).normalized(), 0.05, 0.4};
     }},
    {"a body near more others than a list has", add_small_bodies},
    {"with a deformable body", add_jelly},
    {"with a deformable body and friction",
     [](Scene& scene) {
       add_jelly(scene);
       scene.default_interface.friction = 0.4;
     }},
    {"fixed body with friction",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].fixed = true;
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].angular_velocity.setZero();
     }},
    {"driven body with friction",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].angular_velocity.setZero();
       scene.bodies[0].motion = SlideMotion{{0.8, 0.6, 0}, 0.1, 0.2};
     }},
    {"driven body that rotates, with friction",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].angular_velocity = {1, 8, 3};
       scene.bodies[0].motion = SlideMotion{{0.8, 0.6, 0}, 0.1, 0.2};
     }},
    {"fixed bodies that move, with friction",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].fixed = scene.bodies[1].fixed = true;
       scene.bodies[0].velocity = {0.3, 0.1, 0.2};
       scene.bodies[0].angular_velocity.setZero();
       scene.bodies[1].velocity.setZero();
     }},
    {"bodies that move before their release",
     [](Scene& scene) {
       scene.bodies[0].release = 40 * scene.numerics.step;
       scene.bodies[0].velocity = {0.3, 0.1, 0.2};
       scene.bodies[2].release = 100 * scene.numerics.step;
       scene.bodies[2].velocity.setZero();
     }},
    {"body on an axle with a brake", put_on_axle},
    {"body that rotates on an axle before its release",
     [](Scene& scene) {
       put_on_axle(scene);
       scene.bodies[0].release = 60 * scene.numerics.step;
     }},
    {"strong damping and a body on an axle",
     [](Scene& scene) {
       put_on_axle(scene);
       scene.default_interface.damping = 60;
     }},
    {"two dimensions", set_plane_of_heap},
    {"strong damping", [](Scene& scene) { scene.default_interface.damping = 60; }},
    {"strong damping and friction with a deformable body",
     [](Scene& scene) {
       add_jelly(scene);
       scene.default_interface = {20000, 60, 0.4};
     }},
};

// The device and the CPU compute in double precision, and differ by rounding only.
TEST(RigidDevice, HasTheMotionOfTheCpu) {
  for (const SceneCase& one : kScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_heap();
    one.edit(scene);
    expect_motion_of_cpu(scene, 150);
  }
}

TEST(RigidDevice, SolvesForStrongDamping) {
  Scene scene = make_heap();
  add_jelly(scene);
  scene.default_interface = {20000, 60, 0.4};
  EXPECT_GT(make_on_device(scene).advance(150).iterations.damping, 20U);
}

// RIG-1, a closed-form solution. The tolerance is the published error of Runge-Kutta on the
// quaternion with this step.
TEST(RigidDevice, TurnsAsAnAsymmetricTop) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/tests/validation/scenes/RIG-1.json");
  ASSERT_TRUE(scene.ok());
  Simulation device = make_on_device(scene.value());
  EXPECT_EQ(device.advance(1000).device_steps, 1000U);
  const Quat exact(0.8831781538207485, -0.4241111687539092, 0.19388154793694798,
                   0.05035881771388714);
  EXPECT_LT(device.bodies()[0].pose->orientation.angularDistance(exact.normalized()), 5.23e-9);
}

// The forces of contacts between rigid bodies act at common points, also with friction.
TEST(RigidDevice, ConservesMomentumAndAngularMomentum) {
  constexpr std::uint32_t kSteps = 400;
  Scene scene = make_heap();
  scene.gravity.setZero();
  scene.vat.reset();
  scene.default_interface = {20000, 60, 0.4};
  scene.bodies[1].velocity = {0, 0, -4};
  Simulation device = make_on_device(scene);
  const auto total = [&] {
    std::pair<Vec3, Vec3> sum{Vec3::Zero(), Vec3::Zero()};
    for (const BodyDiagnostics& body : device.diagnostics().bodies) {
      sum.first += body.linear_momentum;
      sum.second += body.angular_momentum;
    }
    return sum;
  };
  const auto before = total();
  const Vec3 of_ball = device.diagnostics().bodies[1].linear_momentum;
  EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
  const auto after = total();
  EXPECT_GT((device.diagnostics().bodies[1].linear_momentum - of_ball).norm(), 0.01) << "contacts";
  // Each step adds ten rounding errors of momenta of at most 10 kg m/s.
  const Real rounding = 10 * 10 * std::sqrt(Real{kSteps}) * 0x1p-53;
  EXPECT_LT((after.first - before.first).norm(), rounding);
  EXPECT_LT((after.second - before.second).norm(), rounding);
}

TEST(RigidDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_heap();
  add_jelly(scene);
  scene.default_interface = {20000, 60, 0.4};
  expect_same_bits_in_any_portions(scene, 12);
}

TEST(RigidDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_heap();
  add_jelly(scene);
  scene.default_interface = {20000, 60, 0.4};
  expect_continuation(scene, 60, rounding_after(60));
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(RigidDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  const Result<Scene> scene =
      read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/sliding-vat-solids.json");
  ASSERT_TRUE(scene.ok());
  Simulation simulation = make_on_device(scene.value());
  EXPECT_EQ(simulation.advance(500).device_steps, 500U);
  EXPECT_EQ(simulation.state_hash(), 0x2c382a03f0780468U);
}

/// A ball with this velocity. The greatest speed of its particles is 20 m/s.
Scene make_ball(const Vec3& velocity, const Vec3& angular_velocity) {
  Scene scene = make_heap();
  scene.vat->max.z() = 4;
  scene.bodies = {make_rigid("ball", {0.3, 0.2, 2}, SphereShape{Vec3::Zero(), 0.08})};
  scene.bodies[0].velocity = velocity;
  scene.bodies[0].angular_velocity = angular_velocity;
  return scene;
}

TEST(RigidDevice, LeavesAFailedStepToTheCpu) {
  struct Case {
    const char* name;
    std::uint32_t steps;
    Vec3 velocity;
    Vec3 angular_velocity;
  };
  const Case cases[] = {{"too fast", 3, {0, 0, 30}, {0, 0, 0}},
                        {"too fast by its rotation", 1, {0, 0, -15}, {100, 0, 0}},
                        {"too fast after the last step", 1, {0, 0, -19.995}, {0, 0, 0}},
                        {"too fast after a step but the first", 2, {0, 0, -19.985}, {0, 0, 0}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    expect_steps_of_cpu(make_ball(one.velocity, one.angular_velocity), one.steps);
  }
}

// A single particle has no speed by its rotation, which is limited to one radian per step.
TEST(RigidDevice, LeavesAFastRotationToTheCpu) {
  Scene scene = make_ball(Vec3::Zero(), {0, 0, 1200});
  scene.bodies[0].shape = make_particles({{0, 0, 0}}, 0.1);
  scene.bodies[0].radius = kHeapSpacing / 2;
  expect_steps_of_cpu(scene, 1);
}

TEST(RigidDevice, RestoresTheStateBeforeAFailedStep) {
  expect_restored_state(make_ball({0, 0, -19.985}, {0, 0, 0}), 1, 2);
}

// Only the CPU moves a rigid body back into the vat.
TEST(RigidDevice, LeavesABodyBeyondAWallToTheCpu) {
  Scene scene = make_ball({0, 0, -15}, {5, 3, 0});
  scene.bodies[0].position.z() = 0.09;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(5).device_steps, 0U);
  EXPECT_GT(cpu.advance(5).wall_stops, 0U);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
}

TEST(RigidDevice, HasTheMotionOfTheCpuWithOtherIntegrators) {
  Scene scene = make_heap();
  add_jelly(scene);
  scene.default_interface.friction = 0.4;
  expect_motion_with_other_integrators(scene, 60);
}

TEST(RigidDevice, HasTheMotionOfTheCpuWithOtherIntegratorsAndHeldBodies) {
  Scene scene = make_heap();
  scene.bodies[0].release = 20 * scene.numerics.step;
  scene.bodies[0].velocity = {0.3, 0.1, 0.2};
  scene.bodies[1].fixed = true;
  expect_motion_with_other_integrators(scene, 60);
}

TEST(RigidDevice, HasTheSameBitsInAnyPortionsOfStepsWithOtherIntegrators) {
  Scene scene = make_heap();
  scene.bodies[0].release = 20 * scene.numerics.step;
  for (const IntegratorId integrator : kOtherIntegrators) {
    scene.numerics.integrator = integrator;
    expect_same_bits_in_any_portions(scene, 2);
  }
}

// The forces that are kept for the next step do not act on a body that was held.
TEST(RigidDevice, HoldsABodyUntilItsRelease) {
  constexpr std::uint32_t kRelease = 30;
  Scene scene = make_heap();
  scene.bodies[1].release = kRelease * scene.numerics.step;
  scene.bodies[1].velocity.setZero();
  scene.bodies[1].angular_velocity.setZero();
  for (const std::uint32_t before : {kRelease - 9, kRelease}) {
    SCOPED_TRACE(before);
    Simulation device = make_on_device(scene);
    Simulation cpu = make_simulation(scene);
    const auto advance = [&](std::uint32_t steps) {
      cpu.advance(steps);
      return device.advance(steps).device_steps;
    };
    EXPECT_EQ(advance(10), 10U);
    const Vec3 held = device.bodies()[1].pose->center_of_mass;
    EXPECT_EQ(advance(10), 10U);
    EXPECT_EQ(device.bodies()[1].pose->center_of_mass, held);
    EXPECT_EQ(advance(before - 20), before - 20);
    Simulation continued = Simulation::from(device.snapshot());  // on the CPU
    continued.advance(40);
    EXPECT_EQ(advance(40), 40U);
    EXPECT_LT(difference(device, continued), rounding_after(40));
    EXPECT_GT((device.bodies()[1].pose->center_of_mass - held).norm(), 0.1 * kHeapSpacing);
    EXPECT_LT(difference(device, cpu), rounding_after(before + 40));
  }
}

// The motion is uniform for a ball. Each step has one rounding error of a position, and about ten
// of an orientation.
TEST(RigidDevice, MovesHeldBodiesByTheirVelocities) {
  constexpr std::uint32_t kSteps = 100;
  const Vec3 velocity(0.3, -0.2, 0.5);
  const Vec3 spin(3, 5, -4);
  Scene fixed = make_ball(velocity, spin);
  fixed.bodies[0].fixed = true;
  Scene held = make_ball(velocity, spin);
  held.bodies[0].release = 1;
  Scene driven = make_ball(Vec3::Zero(), spin);
  driven.bodies[0].motion = SlideMotion{{1, 0, 0}, 0, 1};
  for (Scene* scene : {&fixed, &held, &driven}) {
    for (const IntegratorId id :
         {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler, IntegratorId::heun}) {
      if (id != IntegratorId::velocity_verlet && scene == &driven) continue;
      scene->numerics.integrator = id;
      Simulation device = make_on_device(*scene);
      const RigidPose start = *device.bodies()[0].pose;
      EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
      const RigidPose end = *device.bodies()[0].pose;
      const Vec3 way = device.time() * scene->bodies[0].velocity;
      EXPECT_LT((end.center_of_mass - start.center_of_mass - way).norm(), kSteps * 0x1p-51);
      const Real angle = device.time() * spin.norm();
      const Quat turned =
          Quat(Eigen::AngleAxis<Real>(angle, spin.normalized())) * start.orientation;
      const Real turn = angle / kSteps;
      const Real of_method = id == IntegratorId::heun ? turn * turn * turn : 0;
      EXPECT_LT(end.orientation.angularDistance(turned), kSteps * (of_method + 10 * 0x1p-52));
      EXPECT_NEAR(end.orientation.norm(), 1, 0x1p-51);
    }
  }
}

TEST(RigidDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/bodies/0/axle",
       [](Scene& s) {
         put_on_axle(s);
         s.numerics.integrator = IntegratorId::heun;
       }},
      {"/numerics/integrator",
       [](Scene& s) {
         s.numerics.integrator = IntegratorId::heun;
         s.bodies[0].velocity.setZero();
         s.bodies[0].angular_velocity.setZero();
         s.bodies[0].motion = SlideMotion{{1, 0, 0}, 0.1, 1};
       }},
      {"/numerics/control", [](Scene& s) { s.numerics.control = StepControl::adaptive; }},
  };
  expect_refusals(make_heap(), cases);
}

}  // namespace
}  // namespace vat::device_rigid_test
