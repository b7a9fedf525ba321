#include <gtest/gtest.h>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Inflow, outflow and melting on an OpenCL device. The CPU changes the bodies between the steps of
// the device.

namespace vat::flow_device_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;
constexpr std::uint32_t kSteps = 60;

/// A tap above a column of water. A layer enters every 20 steps.
Scene make_tap() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.numerics.tick = 1e-2;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {400, 0.01, 2 * kSpacing})};
  scene.materials[0].liquid->artificial_viscosity = 0.1;
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"water", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.08}, {0.16, 0.12, 0.16}}, kSpacing}};
  scene.emitters = {make_tap_into("water")};
  return scene;
}

Drain make_drain() {
  return {"hole", {0.1, 0, 0}, {0.16, 0.12, 0.06}};
}

/// Expects that bodies change on the device as on the CPU, and returns the number of particles.
std::size_t expect_changes_of_cpu(const Scene& scene) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  device.advance(kSteps);
  cpu.advance(kSteps);
  EXPECT_EQ(device.diagnostics().emitted_particles, cpu.diagnostics().emitted_particles);
  EXPECT_EQ(device.diagnostics().drained_particles, cpu.diagnostics().drained_particles);
  EXPECT_EQ(device.particle_count(), cpu.particle_count());
  return cpu.particle_count();
}

const SceneCase kTaps[] = {
    {"a tap", [](Scene&) {}},
    {"a tap along the floor",
     [](Scene& scene) {
       scene.emitters[0].position = {0.24, 0.06, 0.041};
       scene.emitters[0].direction = {-1, 0, 0};
     }},
    {"a tap and a hole", [](Scene& scene) { scene.drains = {make_drain()}; }},
    {"a tap, with adaptive steps",
     [](Scene& scene) { scene.numerics.control = StepControl::adaptive; }},
};

TEST(FlowDevice, HasTheAccuracyOfTheCpu) {
  const std::size_t start = make_simulation(make_tap()).particle_count();
  for (const SceneCase& one : kTaps) {
    SCOPED_TRACE(one.name);
    Scene scene = make_tap();
    one.edit(scene);
    EXPECT_NE(expect_changes_of_cpu(scene), start);
  }
  expect_accuracy_of_cpu(make_tap(), kTaps, kSteps);
  // The ball does not reach the floor.
  const SceneCase with_ball[] = {{"a tap above a ball that falls", [](Scene& scene) {
                                    scene.materials.push_back(make_material("stone", 2000));
                                    scene.bodies.push_back({"ball", BodyKind::rigid, "stone",
                                                            SphereShape{{0.22, 0.06, 0.05}, 0.03},
                                                            kSpacing});
                                  }}};
  expect_accuracy_of_cpu(make_tap(), with_ball, kSteps / 2);
}

TEST(FlowDevice, HasTheAccuracyOfTheCpuWithOtherIntegrators) {
  expect_accuracy_with_other_integrators(make_tap(), std::span(kTaps).first(2), 25);
}

TEST(FlowDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_tap();
  scene.drains = {make_drain()};
  expect_same_bits_in_any_portions(scene, 4);
}

TEST(FlowDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_tap();
  scene.drains = {make_drain()};
  expect_continuation(scene, 25, 1e-4 * kSpacing);
}

// The CPU takes the steps without particles.
TEST(FlowDevice, ContinuesAfterTheLastParticlesHaveLeft) {
  Scene scene = make_tap();
  scene.drains = {{"hole", {0, 0, 0}, {0.3, 0.12, 0.3}}};
  scene.emitters[0].from = 0.055;  // the first layer enters the tube at 0.015 s
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(15).device_steps, 0U);
  EXPECT_EQ(device.particle_count(), 0U);
  EXPECT_EQ(device.advance(10).device_steps, 10U);
  EXPECT_GT(device.particle_count(), 0U);
}

// A body that melts adds liquid to the scene.
TEST(FlowDevice, ContinuesAfterABodyHasMelted) {
  Scene scene = make_tap();
  scene.emitters.clear();
  Material wax = make_material("wax", 1000);
  wax.springs = LatticeSprings{SpringConstants{500, 1}, {}, {}};
  scene.materials.push_back(wax);
  BodyDescription block{"block", BodyKind::deformable, "wax",
                        BoxShape{{0.24, 0.06, 0.06}, {0.06, 0.06, 0.06}}, kSpacing};
  block.melting = Melting{"water", 0.02};
  scene.bodies.push_back(block);
  const SceneCase cases[] = {{"a block that melts", [](Scene&) {}}};
  expect_accuracy_of_cpu(scene, cases, 40);
  Simulation device = make_on_device(scene);
  const AdvanceReport report = device.advance(40);
  EXPECT_TRUE(report.bodies_changed);
  EXPECT_EQ(device.bodies()[1].kind, BodyKind::liquid);
}

}  // namespace
}  // namespace vat::flow_device_test
