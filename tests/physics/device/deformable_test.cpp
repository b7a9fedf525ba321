#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Deformable bodies on an OpenCL device.

namespace vat::device_deformable_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.04;

BodyDescription make_jelly(const std::string& name, const Vec3& position, const Vec3& size) {
  BodyDescription body{name, BodyKind::deformable, "jelly", BoxShape{Vec3::Zero(), size}, kSpacing};
  body.position = position;
  return body;
}

/// Two blocks that fall on the floor, on a wall, and on each other.
Scene make_blocks() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("jelly", 400)};
  scene.materials[0].springs =
      LatticeSprings{SpringConstants{600, 1}, SpringConstants{300, 0.5}, SpringConstants{150, 0.2}};
  scene.materials[0].self_contact = SpringConstants{1000, 1};
  scene.default_interface = {5000, 5};
  scene.vat = Vat{{0, 0, 0}, {0.6, 0.4, 0.6}, false, {}};
  scene.bodies = {make_jelly("low", {0.12, 0.2, 0.12}, {0.2, 0.16, 0.2}),
                  make_jelly("high", {0.2, 0.22, 0.34}, {0.16, 0.2, 0.16})};
  scene.bodies[0].velocity = {-1, 0, -1};
  scene.bodies[1].velocity = {-0.5, 0.3, -2};
  return scene;
}

/// A body of two pairs of particles without a spring between the pairs, which approach each other.
/// The particles of a pair start closer than their contact distance.
void make_pairs(Scene& scene) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {0.03, 0, 0}, {0.1, 0.01, 0}, {0.13, 0.01, 0}};
  scene.bodies = {make_body("pairs", BodyKind::deformable, "jelly", make_particles(positions, 0.02),
                            kSpacing / 2)};
  scene.bodies[0].springs = {{0, 1, {600, 1}, {}}, {2, 3, {600, 1}, {}}};
  scene.bodies[0].velocity_field = VectorField{};
  scene.bodies[0].velocity_field->center = {0.065, 0, 0};
  scene.bodies[0].velocity_field->gradient.diagonal() = Vec3(-20, 0, 0);
  scene.vat.reset();
  scene.gravity = Vec3::Zero();
}

const SceneCase kScenes[] = {
    {"friction", [](Scene& scene) { scene.default_interface.friction = 0.4; }},
    {"friction on a moving floor in a sliding vat",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.vat->walls[4].velocity = {1, 0.5, 0};
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0.5).normalized(), 0.1, 0.2};
     }},
    {"another law between the bodies",
     [](Scene& scene) {
       scene.materials.push_back(scene.materials[0]);
       scene.materials[1].name = "rubber";
       scene.materials[1].self_contact.reset();
       scene.bodies[1].material = "rubber";
       scene.interfaces = {{{"jelly", "rubber"}, {9000, 3}, 0.05},
                           {{"rubber", kVatMaterial}, {2000, 1}, 0.1}};
     }},
    {"bulk modulus", [](Scene& scene) { scene.materials[0].bulk_modulus = 4000; }},
    {"bulk modulus in two dimensions",
     [](Scene& scene) {
       scene.dimensions = 2;
       scene.materials[0].density = 16;  // with masses of the same size as in three dimensions
       scene.materials[0].bulk_modulus = 200;
       for (BodyDescription& body : scene.bodies) {
         body.position.y() = 0;
         body.velocity.y() = 0;
       }
       scene.vat->min.y() = -1;
       scene.vat->max.y() = 1;
     }},
    {"contacts within a body", make_pairs},
    {"fixed bodies with friction",
     [](Scene& scene) {
       scene.default_interface.friction = 0.4;
       scene.materials.push_back(make_material("stone", 2000));
       scene.bodies.push_back(make_fixed("ball", SphereShape{{0.14, 0.2, 0.08}, 0.06}, 0.03));
       scene.bodies[0].position.z() = 0.26;
       scene.bodies[1].position.z() = 0.48;
     }},
    {"without damping",
     [](Scene& scene) {
       scene.materials[0].springs = LatticeSprings{SpringConstants{600, 0}, SpringConstants{300, 0},
                                                   SpringConstants{150, 0}};
       scene.materials[0].self_contact.reset();
       scene.default_interface.damping = 0;
     }},
};

// The device and the CPU compute in double precision, and differ by rounding only.
TEST(DeformableDevice, HasTheMotionOfTheCpu) {
  constexpr std::uint32_t kSteps = 120;
  Simulation usual = make_simulation(make_blocks());
  usual.advance(kSteps);
  for (const SceneCase& one : kScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_blocks();
    one.edit(scene);
    expect_motion_of_cpu(scene, kSteps);
    Simulation cpu = make_simulation(scene);
    cpu.advance(kSteps);
    if (cpu.bodies().size() == 2) {
      EXPECT_GT(difference(cpu, usual), 1e-4) << "the change has an effect";
    }
  }
}

TEST(DeformableDevice, SeparatesTheParticlesOfABody) {
  Scene scene = make_blocks();
  make_pairs(scene);
  Simulation device = make_on_device(scene);
  device.advance(120);
  const std::span<const Vec3> positions = device.bodies()[0].positions;
  // The contact springs are longer than the gap between the pairs, but do not act within a pair.
  EXPECT_GT(positions[2].x() - positions[1].x(), kSpacing);
  EXPECT_LT((positions[1] - positions[0]).norm(), 0.8 * kSpacing);
}

/// The position of a particle of a validation case at a time, from tests/validation/reference.json
/// or the closed form.
struct Reference {
  const char* scene;
  Real time;
  std::size_t particle;
  Vec3 position;
  Real tolerance;
};

// The tolerances are the published errors of velocity Verlet with steps of 1 ms. They have two
// digits.
TEST(DeformableDevice, MeetsTheTolerancesOfTheValidation) {
  const Reference references[] = {
      {"DEF-1", 10, 1, {1.1724637744575368, 0, 0}, 4.2e-5},
      {"DEF-4", 5, 1, {0.949794377744, -0.315817142375, 0}, 1.7e-5},
      {"DEF-6b", 5, 7, {2.023102781171, -0.673253969118, 1.103749089255}, 6.9e-5},
  };
  for (const Reference& one : references) {
    SCOPED_TRACE(one.scene);
    const Result<Scene> scene = read_scene_file(
        std::string(VAT_SOURCE_DIR "/tests/validation/scenes/") + one.scene + ".json");
    ASSERT_TRUE(scene.ok());
    Simulation device = make_on_device(scene.value());
    const auto steps =
        static_cast<std::uint32_t>(std::lround(one.time / scene.value().numerics.step));
    EXPECT_EQ(device.advance(steps).device_steps, steps);
    const Vec3 error = device.bodies()[0].positions[one.particle] - one.position;
    EXPECT_LT(error.norm(), 1.02 * one.tolerance);
  }
}

// The spring forces on a free cube are equal and opposite, and central.
TEST(DeformableDevice, ConservesMomentumAndAngularMomentum) {
  constexpr std::uint32_t kSteps = 5000;
  const Result<Scene> scene =
      read_scene_file(VAT_SOURCE_DIR "/tests/validation/scenes/DEF-6b.json");
  ASSERT_TRUE(scene.ok());
  Simulation device = make_on_device(scene.value());
  const Diagnostics before = device.diagnostics();
  EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
  const Diagnostics after = device.diagnostics();
  // Two kicks per step round 8 momenta, which are below 1 kg m/s and at most 3 m from the origin.
  const Real rounding = 3 * std::sqrt(2 * 8 * Real{kSteps}) * 0x1p-53;
  EXPECT_LT((after.bodies[0].linear_momentum - before.bodies[0].linear_momentum).norm(), rounding);
  EXPECT_LT((after.bodies[0].angular_momentum - before.bodies[0].angular_momentum).norm(),
            3 * rounding);
}

TEST(DeformableDevice, StopsParticlesAtWalls) {
  Scene scene = make_blocks();
  scene.gravity = Vec3::Zero();
  scene.default_interface = {};
  // The particles are beyond a wall after one step.
  const std::vector<Vec3> positions = {{0.001, 0.2, 0.2}, {0.599, 0.2, 0.1}, {0.1, 0.001, 0.001}};
  const std::vector<Vec3> velocities = {{-3, 1, 0}, {3, 0, 1}, {0, -3, -4}};
  scene.bodies.clear();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    scene.bodies.push_back(make_body("particle " + std::to_string(i), BodyKind::deformable, "jelly",
                                     make_particles({positions[i]}, 8e-3), 0.01));
    scene.bodies.back().velocity = velocities[i];
  }
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(1).wall_stops, 3U);
  EXPECT_EQ(cpu.advance(1).wall_stops, 3U);
  for (std::size_t body = 0; body < positions.size(); ++body) {
    EXPECT_LT((position_of(device, body) - position_of(cpu, body)).norm(), 4 * 0x1p-53);
    EXPECT_EQ(velocity_of(device, body), velocity_of(cpu, body));
    EXPECT_LT(velocity_of(device, body).norm(), velocities[body].norm() / 2);
  }
}

// Particles at the same position are separated in the direction of the CPU.
TEST(DeformableDevice, SeparatesCoincidentParticles) {
  Scene scene = make_blocks();
  scene.bodies.clear();
  for (int i = 0; i < 3; ++i) {
    scene.bodies.push_back(make_body("particle " + std::to_string(i), BodyKind::deformable, "jelly",
                                     make_particles({{0.3, 0.2, 0.3}}, 0.1), 0.01));
  }
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(20).device_steps, 20U);
  cpu.advance(20);
  EXPECT_GT((position_of(device, 0) - position_of(device, 1)).norm(), 1e-3);
  EXPECT_LT(difference(device, cpu), rounding_after(20));
}

TEST(DeformableDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_blocks();
  scene.default_interface.friction = 0.4;
  expect_same_bits_in_any_portions(scene, 12);
}

TEST(DeformableDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_blocks(), 60, rounding_after(60));
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(DeformableDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  const Result<Scene> scene =
      read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/deformable-drop.json");
  ASSERT_TRUE(scene.ok());
  Simulation simulation = make_on_device(scene.value());
  EXPECT_EQ(simulation.advance(500).device_steps, 500U);
  EXPECT_EQ(simulation.state_hash(), 0xd21ff3ef9fa62e68U);
}

/// A block that falls at this velocity. The greatest speed is that of a particle that passes its
/// contact distance at a wall, half a spacing, in one step: 20 m/s.
Scene make_falling(const Vec3& velocity) {
  Scene scene = make_blocks();
  scene.vat->max.z() = 4;
  scene.bodies.erase(scene.bodies.begin());
  scene.bodies[0].position.z() = 2;
  scene.bodies[0].velocity = velocity;
  return scene;
}

TEST(DeformableDevice, LeavesAFailedStepToTheCpu) {
  struct Case {
    const char* name;
    std::uint32_t steps;
    Vec3 velocity;
  };
  const Case cases[] = {{"too fast", 3, {0, 0, 30}},
                        {"too fast after the last step", 1, {0, 0, -19.995}},
                        {"too fast after a step but the first", 2, {0, 0, -19.985}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    expect_steps_of_cpu(make_falling(one.velocity), one.steps);
  }
}

TEST(DeformableDevice, RestoresTheStateBeforeAFailedStep) {
  expect_restored_state(make_falling({0, 0, -19.985}), 1, 2);
}

// Contacts with strong dampers require a solve. Its iterations are those of the CPU.
TEST(DeformableDevice, SolvesForStrongDamping) {
  const SceneCase cases[] = {
      {"without friction", [](Scene&) {}},
      {"friction", [](Scene& s) { s.default_interface.friction = 0.4; }},
      {"a particle with more contacts than a list of them",
       [](Scene& s) {
         s.bodies.push_back(make_body("ball", BodyKind::deformable, "jelly",
                                      make_particles({{0.12, 0.2, 0.1}}, 1), 0.06));
         s.bodies.back().velocity = {-1, 0, -1};
       }},
      {"contacts across the sides of a periodic world",
       [](Scene& s) {
         s.periodic = Periodicity{{0, 0, 0}, {0.6, 0.4, 0.6}, {true, false, false}};
         s.bodies[0].position.x() = 0.1;
         s.bodies[1].position = {0.52, 0.2, 0.11};
         s.bodies[1].velocity.x() = 0.5;
       }},
  };
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_blocks();
    scene.bodies[0].position.z() = 0.11;
    scene.default_interface = {5000, 60};
    one.edit(scene);
    Simulation device = make_on_device(scene);
    Simulation cpu = make_simulation(scene);
    std::uint64_t iterations = 0;
    for (int tick = 0; tick < 10; ++tick) {
      const AdvanceReport report = device.advance(6);
      EXPECT_EQ(report.device_steps, 6U);
      EXPECT_EQ(report.iterations.damping, cpu.advance(6).iterations.damping) << tick;
      iterations += report.iterations.damping;
    }
    EXPECT_GT(iterations, 60U);
    EXPECT_LT(difference(device, cpu), rounding_after(60));
  }
}

TEST(DeformableDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/numerics/control", [](Scene& s) { s.numerics.control = StepControl::adaptive; }},
  };
  expect_refusals(make_blocks(), cases);
}

}  // namespace
}  // namespace vat::device_deformable_test
