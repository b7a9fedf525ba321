#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "core/laws/contact_damping.h"
#include "protocol/scene/scene_json.h"
#include "tests/physics/device/heap.h"
#include "tests/physics/device/on_device.h"
#include "tests/physics/device/pool.h"

// Layers, and restitution of penalty contacts, on an OpenCL device.

namespace vat::device_contact_terms_test {
namespace {

using namespace test;

void set_layers(Scene& scene) {
  scene.default_interface = {.stiffness = 5000, .law = InterfaceLaw::lennard_jones};
  scene.numerics.step = scene.numerics.tick = 5e-4;
  for (BodyDescription& body : scene.bodies) body.velocity /= 4;
}

void set_restitution(Scene& scene) {
  scene.default_interface = {.stiffness = 20000, .restitution = 0.4};
}

Scene make_heap_with(void (*terms)(Scene&)) {
  Scene scene = make_heap();
  terms(scene);
  return scene;
}

void expect_motion(const Scene& common, std::span<const SceneCase> cases) {
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = common;
    one.edit(scene);
    expect_motion_of_cpu(scene, 150);
  }
}

/// Changes of a heap.
const SceneCase kScenes[] = {
    {"unchanged", [](Scene&) {}},
    {"with a deformable body in a sliding vat",
     [](Scene& scene) {
       add_jelly(scene);
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0.5).normalized(), 0.05, 0.4};
     }},
    {"with a deformable body that touches itself",
     [](Scene& scene) {
       add_jelly(scene);
       scene.materials[1].self_contact = SpringConstants{500, 0.1};
       scene.bodies[3].velocity.z() = -4;
     }},
    {"with implicit springs",
     [](Scene& scene) {
       add_jelly(scene);
       scene.materials[1].implicit_springs = true;
       scene.bodies.resize(1);
       add_jelly(scene);
       scene.materials.pop_back();
     }},
    {"two dimensions", set_plane_of_heap},
    {"through the sides of a periodic world",
     [](Scene& scene) {
       scene.periodic = Periodicity{{0, 0, 0}, {0.6, 0.4, 0}, {true, true, false}};
       scene.bodies[0].velocity.x() = -3;
     }},
    {"a driven, a held and a free body",
     [](Scene& scene) {
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].motion = SlideMotion{{0.8, 0.6, 0}, 0.1, 0.2};
       scene.bodies[1].release = 0.04;
       scene.bodies[1].velocity = {0, 0, 0.5};
     }},
    {"a body on an axle",
     [](Scene& scene) {
       scene.bodies[0].velocity.setZero();
       scene.bodies[0].axle = Axle{{0.6, 0, 0.8}, 0.002};
       scene.bodies[0].angular_velocity = {3, 0, 4};
     }},
};

TEST(LayersDevice, HaveTheMotionOfTheCpu) {
  const SceneCase cases[] = {
      {"given threshold",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", "wood"}, scene.default_interface, 0.03}};
       }},
      {"of a short reach between bodies, and walls with friction",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", "wood"}, scene.default_interface, {}}};
         scene.interfaces[0].constants.reach = 1.3;
         scene.default_interface = {20000, 10, 0.4};
       }},
      {"of walls, and strong damping between bodies",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", "wood"}, {20000, 120, 0.4}, {}}};
         scene.numerics.step = scene.numerics.tick = 1e-3;
       }},
      {"of rigid bodies, and strong damping of a deformable body",
       [](Scene& scene) {
         add_jelly(scene);
         scene.bodies[3].position.x() = 0.35;
         scene.interfaces = {{{"jelly", "wood"}, {5000, 20, 0.4}, {}}};
         scene.numerics.step = scene.numerics.tick = 1e-3;
       }},
      {"of walls, and restitution with friction between bodies",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", "wood"}, {.stiffness = 20000, .friction = 0.4}, {}}};
         scene.interfaces[0].constants.restitution = 0.4;
       }},
  };
  expect_motion(make_heap_with(&set_layers), kScenes);
  expect_motion(make_heap_with(&set_layers), cases);
}

TEST(LayersDevice, HaveTheMotionOfTheCpuWithOtherIntegrators) {
  Scene scene = make_heap_with(&set_layers);
  add_jelly(scene);
  expect_motion_with_other_integrators(scene, 60);
}

// Two particles oscillate about the distance at which the force is zero. The force is nearly linear
// for small amplitudes, so that they are at the other end after half a period.
TEST(LayersDevice, OscillateWithTheirStiffness) {
  constexpr Real kStiffness = 2000;
  constexpr Real kMass = 0.5;
  constexpr Real kAmplitude = 1e-4;  // relative to the distance without force
  constexpr Real kStep = 1e-4;
  constexpr Real kDistance = 0.04;
  Scene scene = make_scene(IntegratorId::velocity_verlet, kStep);
  scene.gravity.setZero();
  scene.materials = {make_material("wood", 600)};
  scene.interfaces = {{{"wood", "wood"}, {.stiffness = kStiffness}, kDistance}};
  scene.interfaces[0].constants.law = InterfaceLaw::lennard_jones;
  const Real half = kDistance / 2;
  for (const Real side : {-1, 1}) {
    const Vec3 place(side * half * (1 + kAmplitude), 0, 0);
    scene.bodies.push_back(make_body(side < 0 ? "left" : "right", BodyKind::deformable, "wood",
                                     make_particles({place}, kMass), half));
  }
  Simulation device = make_on_device(scene);
  const Real omega = std::sqrt(2 * kStiffness / kMass);
  const auto steps = static_cast<std::uint32_t>(std::llround(std::numbers::pi / 2 / omega / kStep));
  EXPECT_EQ(device.advance(steps).device_steps, steps);
  const Real gap = device.bodies()[1].positions[0].x() - device.bodies()[0].positions[0].x();
  // The phase at the end differs from a quarter by half a step at most. The quadratic part of the
  // force shifts the mean distance by about the square of the amplitude, divided by the width of
  // the layer.
  const Real phase = omega * kStep / 2;
  EXPECT_LT(std::abs(gap / kDistance - 1), kAmplitude * (phase + 10 * kAmplitude));
}

/// A particle between a dashpot and a layer with half of its distance without force. The layer
/// belongs to a wall or another particle. Its stiffness is above that without force.
Scene make_squeezed_particle(bool is_wall) {
  constexpr Real kDistance = 0.04;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01);
  scene.gravity.setZero();
  scene.materials = {make_material("dashpot", 600), make_material("middle", 600),
                     make_material("layer", 600)};
  const Real center = kDistance / 4;  // half of a radius from the wall
  scene.vat = Vat{{is_wall ? 0 : -1, -1, -1}, {1, 1, 1}, false, {}};
  const auto add = [&](const char* material, Real x) {
    scene.bodies.push_back(make_body(material, BodyKind::deformable, material,
                                     make_particles({{x, 0, 0}}, 1), kDistance / 2));
  };
  add("dashpot", center + 0.9 * kDistance);
  add("middle", center);
  if (!is_wall) add("layer", center - kDistance / 2);
  InterfaceConstants layer{.stiffness = is_wall ? 6000.0 : 3000.0};
  layer.law = InterfaceLaw::lennard_jones;
  scene.interfaces = {
      {{"dashpot", "middle"}, {10, 25}, kDistance},
      {{"middle", is_wall ? kVatMaterial : "layer"}, layer, is_wall ? kDistance / 2 : kDistance}};
  return scene;
}

// A step solves for damping only because of the stiffness of the layer.
TEST(LayersDevice, DecideWhetherAStepSolvesForDamping) {
  for (const bool is_wall : {false, true}) {
    Scene scene = make_squeezed_particle(is_wall);
    expect_motion_of_cpu(scene, 2);
    EXPECT_GT(make_on_device(scene).advance(2).iterations.damping, 0U);
    scene.interfaces[1].constants.stiffness /= 5;
    EXPECT_EQ(make_on_device(scene).advance(2).iterations.damping, 0U);
  }
}

TEST(RestitutionDevice, HasTheMotionOfTheCpu) {
  const SceneCase cases[] = {
      {"friction on a moving floor",
       [](Scene& scene) {
         scene.default_interface.friction = 0.4;
         scene.vat->walls[4].velocity = {1, 0.5, 0};
       }},
      {"strong damping",
       [](Scene& scene) {
         scene.default_interface = {.stiffness = 20000, .restitution = 0.05};
         scene.numerics.step = scene.numerics.tick = 2e-3;
       }},
      {"strong damping and friction with a deformable body",
       [](Scene& scene) {
         add_jelly(scene);
         scene.default_interface = {.stiffness = 20000, .friction = 0.4, .restitution = 0.05};
       }},
      {"bodies that pass through each other",
       [](Scene& scene) {
         add_jelly(scene);
         scene.bodies[3].position.x() = 0.3;
         scene.interfaces = {{{"wood", "jelly"}, {}, {}}};
       }},
      {"projection between bodies, and soft walls",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", "wood"}, {.law = InterfaceLaw::projection}, {}}};
       }},
  };
  expect_motion(make_heap_with(&set_restitution), kScenes);
  expect_motion(make_heap_with(&set_restitution), cases);
}

TEST(RestitutionDevice, HasTheMotionOfTheCpuWithOtherIntegrators) {
  Scene scene = make_heap_with(&set_restitution);
  add_jelly(scene);
  scene.default_interface.friction = 0.4;
  expect_motion_with_other_integrators(scene, 60);
}

TEST(RestitutionDevice, SolvesForStrongDamping) {
  Scene scene = make_heap();
  add_jelly(scene);
  scene.default_interface = {.stiffness = 20000, .friction = 0.4, .restitution = 0.05};
  EXPECT_GT(make_on_device(scene).advance(150).iterations.damping, 20U);
}

// A plate falls flat on the floor, so that several contacts act at once. The dashpots of the first
// step in contact act for up to a step too long or too short.
TEST(RestitutionDevice, ReboundsWithTheRatioOfSpeeds) {
  constexpr Real kRestitution = 0.6;
  constexpr Real kSpeed = 0.1;
  constexpr Real kStiffness = 200;
  constexpr Real kStep = 2e-4;
  Scene scene = make_heap();
  scene.gravity.setZero();
  scene.bodies.resize(1);
  scene.bodies[0].position.z() = 0.065;
  scene.bodies[0].velocity = {0, 0, -kSpeed};
  scene.bodies[0].angular_velocity.setZero();
  scene.default_interface = {.stiffness = kStiffness, .restitution = kRestitution};
  scene.numerics.step = scene.numerics.tick = kStep;
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(2500).device_steps, 2500U);
  constexpr Real kContacts = 5 * 4;
  const Real omega = std::sqrt(kContacts * kStiffness / device.diagnostics().bodies[0].mass);
  const Real rate = 2 * damping_ratio_for(kRestitution) * omega;
  EXPECT_NEAR(device.bodies()[0].pose->velocity.z(), kRestitution * kSpeed, rate * kStep * kSpeed);
}

TEST(ContactTermsDevice, HaveTheSameBitsInAnyPortionsOfSteps) {
  for (const auto terms : {&set_layers, &set_restitution}) {
    Scene scene = make_heap_with(terms);
    add_jelly(scene);
    expect_same_bits_in_any_portions(scene, 12);
  }
}

TEST(ContactTermsDevice, ContinueAStateOfTheCpuAndTheReverse) {
  for (const auto terms : {&set_layers, &set_restitution}) {
    Scene scene = make_heap_with(terms);
    add_jelly(scene);
    expect_continuation(scene, 60, rounding_after(60));
  }
}

const SceneCase kPools[] = {
    {"layers",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.default_interface = {.stiffness = 100, .law = InterfaceLaw::lennard_jones};
     }},
    {"restitution",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.default_interface = {.stiffness = 1000, .friction = 0.3, .restitution = 0.95};
     }},
};

TEST(ContactTermsDevice, HaveTheAccuracyOfTheCpuInLiquids) {
  expect_accuracy_of_cpu(make_pool(), kPools, 20);
  expect_accuracy_of_cpu(make_pool(PressureSolver::incompressible), kPools, 15, 4);
}

// The catalogue scene with layers between a pump and tissue.
TEST(ContactTermsDevice, HaveTheAccuracyOfTheCpuInABloodVessel) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/blood-vessel.json");
  ASSERT_TRUE(scene.ok());
  const SceneCase cases[] = {{"unchanged", [](Scene&) {}}};
  expect_accuracy_of_cpu(scene.value(), cases, 60);
}

TEST(ContactTermsDevice, SolveForStrongDampingInLiquids) {
  constexpr std::uint32_t kSteps = 30;
  Scene scene = make_pool();
  add_other_ball(scene);
  scene.default_interface = {.stiffness = 3000, .friction = 0.4, .restitution = 0.05};
  expect_damping_of_cpu(scene, kSteps, kSteps / 5);
}

TEST(ContactTermsDevice, ChooseTheStepsOfTheCpu) {
  const SceneCase cases[] = {
      {"layers of balls",
       [](Scene& scene) {
         kPools[0].edit(scene);
         scene.interfaces = {{{"wood", kVatMaterial}, {1000, 0.2}, {}}};
       }},
      {"layers of walls",
       [](Scene& scene) {
         scene.interfaces = {{{"wood", kVatMaterial}, {.stiffness = 300}, {}}};
         scene.interfaces[0].constants.law = InterfaceLaw::lennard_jones;
         scene.bodies[1].velocity = {-0.3, 0, 0};
       }},
      {"restitution", kPools[1].edit},
      {"strong damping at a wall",
       [](Scene& scene) {
         scene.default_interface = {.stiffness = 1000, .friction = 0.3, .restitution = 0.2};
         scene.bodies[1].velocity = {-1, 0, 0};
       }},
  };
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_pool(PressureSolver::incompressible);
    scene.numerics.step = scene.numerics.tick = 0.02;
    scene.numerics.control = StepControl::adaptive;
    scene.materials[0].liquid->viscosity = 0;
    one.edit(scene);
    expect_adaptive_steps_of_cpu(scene, 3);
  }
}

}  // namespace
}  // namespace vat::device_contact_terms_test
