#include <gtest/gtest.h>

#include "tests/physics/device/heap.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Contacts by projection on an OpenCL device.

namespace vat::device_projection_test {
namespace {

using namespace test;

constexpr std::uint32_t kSteps = 60;

BodyDescription make_marble(const std::string& name, const Vec3& position, const Vec3& velocity) {
  BodyDescription marble =
      make_body(name, BodyKind::rigid, "wood", make_particles({{0, 0, 0}}, 0.5), 0.05);
  marble.position = position;
  marble.velocity = velocity;
  return marble;
}

/// Marbles that meet each other, a wall and the floor, and a block of jelly beside them.
Scene make_marbles() {
  Scene scene = make_heap();
  scene.default_interface = {};
  scene.default_interface.law = InterfaceLaw::projection;
  scene.bodies = {make_marble("first", {0.06, 0.2, 0.07}, {-1, 0.2, -1}),
                  make_marble("second", {0.2, 0.21, 0.06}, {-2, 0, -0.5}),
                  make_marble("third", {0.3, 0.2, 0.051}, {-3, 0, 0})};
  scene.bodies[0].angular_velocity = {10, -20, 5};
  add_jelly(scene);
  scene.bodies[3].position.z() = 0.085;
  return scene;
}

const SceneCase kScenes[] = {
    {"without friction", [](Scene&) {}},
    {"bouncing", [](Scene& scene) { scene.default_interface.restitution = 0.7; }},
    {"friction", [](Scene& scene) { scene.default_interface.friction = 0.4; }},
    {"friction on a moving floor",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.vat->walls[4].velocity = {1, 0.5, 0};
     }},
    {"jelly and a marble with friction in a sliding vat",
     [](Scene& scene) {
       scene.bodies.erase(scene.bodies.begin(), scene.bodies.begin() + 2);
       scene.default_interface.friction = 0.4;
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0.5).normalized(), 0.05, 0.4};
     }},
    {"springs between marbles, and hard walls",
     [](Scene& scene) {
       scene.interfaces = {{{"wood", "wood"}, {20000, 10, 0.4}, {}}};
       scene.default_interface.restitution = 0.5;
     }},
    {"implicit springs",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.materials[1].implicit_springs = true;
       scene.bodies[3].position.z() = 0.07;  // near the floor
     }},
    {"symplectic Euler",
     [](Scene& scene) {
       scene.default_interface.restitution = 0.5;
       scene.numerics.integrator = IntegratorId::symplectic_euler;
     }},
    {"fixed marble",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].fixed = true;
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].angular_velocity.setZero();
     }},
    {"fixed marble that moves",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.bodies[0].fixed = true;
       scene.bodies[0].velocity = {0.5, 0, 0};
     }},
    {"marble that moves before its release",
     [](Scene& scene) { scene.bodies[1].release = 20 * scene.numerics.step; }},
    {"through the sides of a periodic world",
     [](Scene& scene) {
       scene.periodic = Periodicity{{0, 0, 0}, {0.6, 0.4, 0}, {true, true, false}};
       scene.bodies[0].velocity.x() = -3;
       scene.bodies[3].position.x() = 0.53;
     }},
    {"in a gas",
     [](Scene& scene) {
       scene.materials.push_back(make_liquid("air", 600, {50, 1, 2 * kHeapSpacing}));
       scene.bodies.push_back(BodyDescription{"air", BodyKind::liquid, "air",
                                              BoxShape{{0.3, 0.2, 0.3}, {0.16, 0.2, 0.16}},
                                              kHeapSpacing});
       scene.bodies[4].velocity.z() = -4;
     }},
};

// All sweeps of these scenes converge without Newton's method, so that the device has the same
// iterations as the CPU.
TEST(ProjectionDevice, HasTheMotionOfTheCpu) {
  for (const SceneCase& one : kScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_marbles();
    one.edit(scene);
    expect_motion_of_cpu(scene, kSteps);
    Simulation cpu = make_simulation(scene);
    EXPECT_GT(cpu.advance(kSteps).iterations.contacts, 4 * kSteps);
  }
}

// The CPU solves for some contacts at rest by Newton's method. The sweeps of both change no contact
// by more than 1e-8 of its distance in a step.
TEST(ProjectionDevice, RestsLikeTheCpu) {
  constexpr std::uint32_t kLong = 200;
  Scene scene = make_marbles();
  scene.default_interface.friction = 0.4;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(kLong).device_steps, kLong);
  cpu.advance(kLong);
  EXPECT_LT(difference(device, cpu), kLong * 1e-8 * 0.1);
}

TEST(ProjectionDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_marbles();
  scene.default_interface.friction = 0.4;
  expect_same_bits_in_any_portions(scene, 6);
}

// The state has the forces of contacts, with which the next solves start.
TEST(ProjectionDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_marbles();
  scene.default_interface.friction = 0.4;
  expect_continuation(scene, 40, rounding_after(40));
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(ProjectionDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Scene scene = make_marbles();
  scene.default_interface.friction = 0.4;
  Simulation simulation = make_on_device(scene);
  EXPECT_EQ(simulation.advance(100).device_steps, 100U);
  EXPECT_EQ(simulation.state_hash(), 0xcf610b9a4ee42821U);
}

// Only the CPU has Newton's method for contacts whose sweeps converge too slowly.
TEST(ProjectionDevice, LeavesSlowSweepsToTheCpu) {
  Scene scene = make_heap();
  scene.default_interface = make_marbles().default_interface;
  scene.default_interface.friction = 0.4;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(200).device_steps, 0U);
  EXPECT_EQ(cpu.advance(200).undone_steps, 0U);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
}

TEST(ProjectionDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/default_interface",
       [](Scene& s) {
         s.bodies[0].velocity.setZero();
         s.bodies[0].angular_velocity.setZero();
         s.bodies[0].motion = SlideMotion{{1, 0, 0}, 0.1, 1};
       }},
      {"/interfaces",
       [](Scene& s) {
         s.bodies[0].velocity.setZero();
         s.bodies[0].motion = SlideMotion{{1, 0, 0}, 0.1, 1};
         s.interfaces = {{{"wood", kVatMaterial}, {20000, 10}, {}}};
       }},
  };
  expect_refusals(make_marbles(), cases);
}

}  // namespace
}  // namespace vat::device_projection_test
