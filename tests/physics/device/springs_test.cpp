#include <gtest/gtest.h>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Springs that flow or tear, are implicit, or have a limit, on an OpenCL device.

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

/// Stiff implicit springs in steps that are ten times too long for explicit springs.
Scene make_implicit() {
  Scene scene = make_clay();
  scene.numerics.step = 4e-3;
  scene.numerics.tick = 4e-3;
  scene.materials[0].plasticity.reset();
  scene.materials[0].implicit_springs = true;
  scene.materials[0].springs =
      LatticeSprings{SpringConstants{6e4, 5}, SpringConstants{3e4, 2}, SpringConstants{1.5e4, 1}};
  return scene;
}

/// Replaces the block by a lattice of particles, some of which are fixed.
void fix_particles(Scene& scene, std::vector<Index> fixed) {
  const std::vector<Vec3> positions = make_lattice(4, 3, 3, kSpacing);
  ParticleShape shape = make_particles(positions, 0.02);
  shape.fixed = std::move(fixed);
  scene.bodies[0] =
      make_body("block", BodyKind::deformable, "clay", std::move(shape), kSpacing / 2);
  scene.bodies[0].springs = join_near(positions, 1.8 * kSpacing, {3e4, 2});
  scene.gravity = {0, 0, -9.81};
}

const SceneCase kImplicitScenes[] = {
    {"free", [](Scene&) {}},
    {"without dashpots",
     [](Scene& scene) {
       scene.materials[0].springs =
           LatticeSprings{SpringConstants{6e4, 0}, SpringConstants{3e4, 0}, {}};
     }},
    {"in two dimensions",
     [](Scene& scene) {
       scene.dimensions = 2;
       scene.materials[0].density = 20;
       scene.bodies[0].velocity_field->gradient << 40, 0, -10, 0, 0, 0, 10, 0, 0;
     }},
    {"a pendulum", [](Scene& scene) { fix_particles(scene, {0}); }},
    {"a beam",
     [](Scene& scene) {
       fix_particles(scene, {0, 4, 8, 12, 16, 20, 24, 28, 32});
     }},
    {"flowing and tearing",
     [](Scene& scene) {
       scene.materials[0].plasticity = Plasticity{.yield_strain = 1e-3};
       tear(scene);
     }},
    {"beside explicit springs, on a floor with friction",
     [](Scene& scene) {
       scene.materials.push_back(make_clay().materials[0]);
       scene.materials[1].name = "jelly";
       scene.materials[1].plasticity.reset();
       scene.numerics.step = 1e-3;
       scene.numerics.tick = 1e-3;
       scene.bodies.push_back(scene.bodies[0]);
       scene.bodies[1].name = "jelly";
       scene.bodies[1].material = "jelly";
       scene.bodies[1].position = {0.02, 0.03, 0.17};
       scene.bodies[1].velocity_field.reset();
       scene.bodies[1].velocity.z() = -2;
       scene.default_interface = {5000, 5, 0.4};
       scene.gravity = {0, 0, -9.81};
       scene.vat = Vat{{-1, -1, -0.08}, {1, 1, 1}, false, {}};
     }},
    {"in a gas",
     [](Scene& scene) {
       scene.materials.push_back(make_liquid("air", 1000, {50, 1, 2 * kSpacing}));
       scene.bodies.push_back(BodyDescription{"air", BodyKind::liquid, "air",
                                              BoxShape{{0, 0, 0.16}, {0.2, 0.12, 0.12}}, kSpacing});
       scene.default_interface = {1000, 2};
       scene.numerics.step = 1e-3;
       scene.numerics.tick = 1e-3;
     }},
    {"too wide for a factor",
     [](Scene& scene) {
       scene.bodies[0].shape = BoxShape{Vec3::Zero(), {0.24, 0.28, 0.28}};
       scene.bodies[0].velocity_field->gradient /= 2;
     }},
    {"turned inside out, in parts of a drift",
     [](Scene& scene) { scene.bodies[0].velocity_field->gradient *= -30; }},
};

TEST(ImplicitSpringsDevice, HaveTheMotionOfTheCpu) {
  const Simulation usual = make_advanced(make_implicit(), 25);
  for (const SceneCase& one : kImplicitScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_implicit();
    one.edit(scene);
    expect_motion_of_cpu(scene, 25);
    Simulation device = make_on_device(scene);
    Simulation cpu = make_simulation(scene);
    const AdvanceReport report = device.advance(25);
    const AdvanceReport expected = cpu.advance(25);
    EXPECT_GT(expected.iterations.springs, 100U);
    if (&one != kImplicitScenes &&
        cpu.bodies()[0].positions.size() == usual.bodies()[0].positions.size()) {
      EXPECT_GT(difference(usual, cpu), 1e-4) << "the change has an effect";
    }
    EXPECT_EQ(report.particle_evaluations, expected.particle_evaluations);
    EXPECT_EQ(report.unsolved_drifts, expected.unsolved_drifts);
  }
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(ImplicitSpringsDevice, HaveTheSameBitsOnEveryDeviceIfExact) {
  Simulation simulation = make_on_device(make_implicit());
  EXPECT_EQ(simulation.advance(25).device_steps, 25U);
  EXPECT_EQ(simulation.state_hash(), 0xc43130cdf2b819f6U);
}

TEST(ImplicitSpringsDevice, HaveTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_implicit(), 2);
}

TEST(ImplicitSpringsDevice, ContinueAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_implicit(), 20, rounding_after(20));
}

/// A cloth that swings from one corner. Its springs are too soft for its weight.
Scene make_cloth() {
  Scene scene = make_clay();
  const std::vector<Vec3> positions = make_lattice(8, 8, 1, kSpacing);
  ParticleShape shape = make_particles(positions, 0.02);
  shape.fixed = {0};
  scene.bodies[0] = make_body("cloth", BodyKind::deformable, "clay", shape, kSpacing / 2);
  scene.bodies[0].springs = join_near(positions, 1.5 * kSpacing, {20, 0.05});
  scene.materials[0].plasticity.reset();
  scene.materials[0].elongation_limit = 0.05;
  scene.numerics.step = scene.numerics.tick = 4e-3;
  scene.gravity = {0, 0, -9.81};
  return scene;
}

const SceneCase kLimitedScenes[] = {
    {"cloth", [](Scene&) {}},
    {"symplectic Euler",
     [](Scene& scene) { scene.numerics.integrator = IntegratorId::symplectic_euler; }},
    {"tearing cloth", [](Scene& scene) { scene.materials[0].tearing_strain = 0.0502; }},
    {"beside implicit springs",
     [](Scene& scene) {
       scene.materials.push_back(make_implicit().materials[0]);
       scene.materials[1].name = "steel";
       scene.bodies.push_back(make_implicit().bodies[0]);
       scene.bodies[1].name = "block";
       scene.bodies[1].material = "steel";
       scene.bodies[1].position.z() = -0.3;
     }},
};

TEST(LimitedSpringsDevice, HaveTheMotionOfTheCpu) {
  Scene soft = make_cloth();
  soft.materials[0].elongation_limit.reset();
  const Simulation usual = make_advanced(soft, 40);
  for (const SceneCase& one : kLimitedScenes) {
    SCOPED_TRACE(one.name);
    Scene scene = make_cloth();
    one.edit(scene);
    expect_motion_of_cpu(scene, 40);
    Simulation cpu = make_simulation(scene);
    EXPECT_GT(cpu.advance(40).iterations.elongation, 80U) << "some steps need several sweeps";
    EXPECT_GT(difference(usual, cpu), 1e-3) << "springs reach their limit";
    EXPECT_EQ(cpu.diagnostics().torn_springs > 0, scene.materials[0].tearing_strain.has_value());
  }
}

TEST(LimitedSpringsDevice, HaveTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_cloth(), 2);
}

}  // namespace
}  // namespace vat::device_springs_test
