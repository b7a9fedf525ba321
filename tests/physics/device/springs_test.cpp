#include <gtest/gtest.h>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Springs that flow or tear on an OpenCL device.

namespace vat::device_springs_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.04;
constexpr std::uint32_t kSteps = 100;

/// A free block of clay that is stretched along one axis, and turns.
Scene make_clay() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity.setZero();
  scene.materials = {make_material("clay", 400)};
  scene.materials[0].springs =
      LatticeSprings{SpringConstants{600, 1}, SpringConstants{300, 0.5}, SpringConstants{150, 0.2}};
  scene.materials[0].plasticity = Plasticity{.yield_strain = 0.02};
  scene.bodies = {BodyDescription{"block", BodyKind::deformable, "clay",
                                  BoxShape{Vec3::Zero(), {0.2, 0.12, 0.12}}, kSpacing}};
  VectorField field;
  field.gradient << 40, -10, 0, 10, 0, 0, 0, 0, 0;
  scene.bodies[0].velocity_field = field;
  return scene;
}

void tear(Scene& scene) {
  scene.materials[0].tearing_strain = 0.15;
}

const SceneCase kScenes[] = {
    {"plastic", [](Scene&) {}},
    {"hardening up to a greatest strain",
     [](Scene& scene) {
       scene.materials[0].plasticity->hardening = 0.3;
       scene.materials[0].plasticity->max_strain = 0.06;
     }},
    {"relaxation", [](Scene& scene) { scene.materials[0].plasticity->relaxation_time = 0.01; }},
    {"plastic and tearing", tear},
    {"tearing",
     [](Scene& scene) {
       tear(scene);
       scene.materials[0].plasticity.reset();
     }},
    {"beside another material",
     [](Scene& scene) {
       scene.materials.push_back(scene.materials[0]);
       scene.materials[1].name = "jelly";
       scene.materials[1].plasticity.reset();
       scene.bodies.push_back(scene.bodies[0]);
       scene.bodies[1].name = "jelly";
       scene.bodies[1].material = "jelly";
       scene.bodies[1].position.z() = 0.5;
       scene.bodies[1].velocity_field->center = scene.bodies[1].position;
     }},
};

TEST(SpringsDevice, HasTheMotionOfTheCpu) {
  Scene elastic = make_clay();
  elastic.materials[0].plasticity.reset();
  Simulation usual = make_simulation(elastic);
  usual.advance(kSteps);
  for (const SceneCase& one : kScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_clay();
    one.edit(scene);
    expect_motion_of_cpu(scene, kSteps);
    Simulation device = make_on_device(scene);
    Simulation cpu = make_simulation(scene);
    device.advance(kSteps);
    cpu.advance(kSteps);
    const std::uint64_t torn = cpu.diagnostics().torn_springs;
    EXPECT_EQ(device.diagnostics().torn_springs, torn);
    EXPECT_EQ(torn > 0, scene.materials[0].tearing_strain.has_value());
    if (scene.bodies.size() == 1) {
      EXPECT_GT(difference(cpu, usual), 1e-3) << "the springs change";
    }
  }
}

TEST(SpringsDevice, HasTheMotionOfTheCpuWithOtherIntegrators) {
  Scene scene = make_clay();
  tear(scene);
  expect_motion_with_other_integrators(scene, kSteps);
}

TEST(SpringsDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_clay();
  tear(scene);
  expect_same_bits_in_any_portions(scene, 8);
}

TEST(SpringsDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_clay();
  tear(scene);
  expect_continuation(scene, kSteps / 2, rounding_after(kSteps / 2));
}

// The block flows while a heavy particle falls on it, too fast for the guard after one step.
TEST(SpringsDevice, RestoresTheSpringsBeforeAFailedStep) {
  Scene scene = make_clay();
  scene.gravity = {0, 0, -10};
  scene.bodies.push_back(
      make_body("stone", BodyKind::deformable, "clay", make_particles({{0, 0, 2}}, 0.02), 0.01));
  scene.bodies[1].velocity = {0, 0, -19.5};
  expect_restored_state(scene, 40, 30);
}

// The CPU changes the springs before a wall stops their particles.
TEST(SpringsDevice, LeavesStopsAtWallsToTheCpu) {
  Scene scene = make_clay();
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.vat = Vat{{-0.085, -1, -1}, {1, 1, 1}, false, {}};
  scene.default_interface = {};
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(kSteps).device_steps, 0U);
  EXPECT_GT(cpu.advance(kSteps).wall_stops, 0U);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
}

}  // namespace
}  // namespace vat::device_springs_test
