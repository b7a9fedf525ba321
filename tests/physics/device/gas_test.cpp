#include <gtest/gtest.h>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/scenes.h"

// Gas-like liquids on an OpenCL device.

namespace vat::device_gas_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

/// A column of water that falls on the floor of a vat.
Scene make_pool() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 5e-4);
  scene.pressure_solver = PressureSolver::gas;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {20, 2, 2 * kSpacing})};
  scene.default_interface = {20'000, 2};  // walls hold the liquid without stops
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.09}, {0.12, 0.1, 0.16}}, kSpacing}};
  scene.bodies[0].velocity = {-0.5, 0, -1};
  return scene;
}

void add_solid(Scene& scene, BodyKind kind, const Vec3& position) {
  Material wood = make_material("wood", 500);
  wood.springs = LatticeSprings{SpringConstants{600, 0.1}, SpringConstants{300, 0.05},
                                SpringConstants{150, 0}};
  scene.materials.push_back(wood);
  BodyDescription body{"solid", kind, "wood", BoxShape{Vec3::Zero(), {0.06, 0.06, 0.06}}, kSpacing};
  body.position = position;
  body.velocity = {0, 0, -1};
  scene.bodies.push_back(body);
}

/// Adds a drop of another liquid above the column, which falls on it.
void add_oil(Scene& scene) {
  scene.materials.push_back(make_liquid("oil", 800, {15, 5, 2.5 * kSpacing}));
  BodyDescription drop{"drop", BodyKind::liquid, "oil", SphereShape{Vec3::Zero(), 0.04}, kSpacing};
  drop.position = {0.09, 0.06, 0.215};
  drop.velocity = {0, 0, -2};
  scene.bodies.push_back(drop);
}

const SceneCase kScenes[] = {
    {"two liquids that touch", add_oil},
    {"two bodies of one liquid that touch, beside a ball",
     [](Scene& scene) {
       add_oil(scene);
       scene.bodies[1].material = "water";
       scene.materials.pop_back();
       add_solid(scene, BodyKind::rigid, {0.25, 0.06, 0.3});
     }},
    {"ball on a liquid with friction",
     [](Scene& scene) {
       add_solid(scene, BodyKind::rigid, {0.09, 0.06, 0.205});
       scene.bodies[1].angular_velocity = {2, 5, -1};
       scene.default_interface.friction = 0.3;
     }},
    {"restitution of a body, and layers of walls",
     [](Scene& scene) {
       add_solid(scene, BodyKind::rigid, {0.09, 0.06, 0.205});
       const InterfaceConstants bouncing{.stiffness = scene.default_interface.stiffness,
                                         .restitution = 0.5};
       scene.interfaces = {{{"water", "wood"}, bouncing, {}},
                           {{"water", kVatMaterial}, {.stiffness = 100}, {}}};
       scene.interfaces[1].constants.law = InterfaceLaw::lennard_jones;
     }},
    {"fixed body that moves through a liquid",
     [](Scene& scene) {
       add_solid(scene, BodyKind::rigid, {0.09, 0.06, 0.205});
       scene.bodies[1].angular_velocity = {2, 5, -1};
       scene.bodies[1].fixed = true;
     }},
    {"deformable body on a liquid",
     [](Scene& scene) {
       add_solid(scene, BodyKind::deformable, {0.09, 0.06, 0.205});
     }},
    {"central field and a solid",
     [](Scene& scene) {
       scene.vat.reset();
       scene.gravity.setZero();
       scene.central_field = CentralField{{0.08, 0.05, 0.2}, 12};
       add_solid(scene, BodyKind::deformable, {0.25, 0.06, 0.3});
     }},
    {"no-slip walls that move", set_no_slip},
    {"no-slip walls in two dimensions",
     [](Scene& scene) {
       set_plane_of_liquid(scene);
       set_no_slip(scene);
       scene.vat->walls[2] = {};  // there is no wall along the plane
     }},
    {"without viscosity", [](Scene& scene) { scene.forces.viscosity = false; }},
    {"without pressure", [](Scene& scene) { scene.forces.pressure = false; }},
    {"without damping",
     [](Scene& scene) {
       scene.forces.viscosity = false;
       scene.default_interface.damping = 0;
     }},
    {"without a vat and gravity",
     [](Scene& scene) {
       scene.vat.reset();
       scene.gravity.setZero();
       scene.default_interface = {};
       add_oil(scene);
     }},
};

void expect_motion(const Scene& common, std::span<const SceneCase> cases) {
  constexpr std::uint32_t kSteps = 60;
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = common;
    one.edit(scene);
    expect_motion_of_cpu(scene, kSteps);
  }
}

// The device and the CPU compute in double precision, and differ by rounding only.
TEST(GasDevice, HasTheMotionOfTheCpu) {
  expect_motion(make_pool(), kCommonScenes);
  expect_motion(make_pool(), kScenes);
}

TEST(GasDevice, HasTheMotionOfTheCpuWithOtherIntegrators) {
  Scene scene = make_pool();
  add_oil(scene);
  expect_motion_with_other_integrators(scene, 60);
}

TEST(GasDevice, SolvesForStrongDampingOfContacts) {
  constexpr std::uint32_t kSteps = 60;
  Scene scene = make_pool();
  add_solid(scene, BodyKind::rigid, {0.09, 0.06, 0.205});
  scene.default_interface = {20'000, 60};
  expect_damping_of_cpu(scene, kSteps, 1);
}

void expect_conservation(BodyKind kind) {
  Scene scene = make_collision(BodyKind::liquid, kind, IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::gas;
  Simulation device = make_on_device(scene);
  const MomentumWatch watch(device);
  const Vec3 start = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_EQ(device.advance(100).device_steps, 100U);
  const Vec3 end = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_GT((end - start).norm(), 0.1 * start.norm());
  watch.expect_momentum(rounding_after(100));
  watch.expect_angular_momentum(rounding_after(100));
}

TEST(GasDevice, ConservesMomentum) {
  expect_conservation(BodyKind::rigid);
  expect_conservation(BodyKind::deformable);
}

TEST(GasDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_pool();
  add_oil(scene);
  expect_same_bits_in_any_portions(scene, 4);
}

TEST(GasDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_pool();
  add_oil(scene);
  expect_continuation(scene, 20, kSpacing * rounding_after(20));
}

TEST(GasDevice, LeavesAFailedStepToTheCpu) {
  Scene scene = make_pool();
  scene.bodies[0].velocity = {0, 0, 25};  // faster than the guard permits
  expect_steps_of_cpu(scene, 2);
}

TEST(GasDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/numerics/step", [](Scene& s) { s.materials[0].liquid->viscosity = 2000; }},
      {"/numerics/control", [](Scene& s) { s.numerics.control = StepControl::adaptive; }},
  };
  expect_refusals(make_pool(), cases);
}

}  // namespace
}  // namespace vat::device_gas_test
