#include <gtest/gtest.h>

#include <cmath>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/physics/device/pool.h"

// Moving solids in incompressible liquids on an OpenCL device.

namespace vat::device_incompressible_solids_test {
namespace {

using namespace test;

Scene make_incompressible_pool() {
  return make_pool(PressureSolver::incompressible);
}

const SceneCase kRigidScenes[] = {
    {"ball", [](Scene&) {}},
    {"two balls in contact in a sliding vat",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
     }},
    {"ball with contacts by projection",
     [](Scene& scene) { scene.default_interface.law = InterfaceLaw::projection; }},
    {"ball and fixed body",
     [](Scene& scene) {
       scene.bodies.push_back(
           make_fixed("sill", BoxShape{{0.22, 0.06, 0.02}, {0.04, 0.12, 0.04}}, kPoolSpacing));
       scene.bodies.back().material = "wood";
     }},
    {"ball between no-slip walls that move", set_no_slip},
    {"ball in two dimensions", set_plane},
};

const SceneCase kDeformableScenes[] = {
    {"jelly and ball", add_wet_jelly},
    {"only jelly, in a sliding vat",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.bodies.erase(scene.bodies.begin() + 1);
       scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
     }},
    {"jelly with a bulk modulus",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.materials[2].bulk_modulus = 2000;
     }},
    {"plastic jelly",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.materials[2].plasticity = Plasticity{.yield_strain = 0};
     }},
    {"jelly with limited springs",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.materials[2].elongation_limit = 0.01;
     }},
};

const SceneCase kGuidedScenes[] = {
    {"ball that is released",
     [](Scene& scene) {
       scene.bodies[1].release = 10 * scene.numerics.step;
       scene.bodies[1].position.z() = 0.12;
       scene.bodies[1].velocity.setZero();
       scene.bodies[1].angular_velocity.setZero();
     }},
    {"ball that moves before its release",
     [](Scene& scene) {
       scene.bodies[1].release = 8 * scene.numerics.step;
       scene.bodies[1].position.z() = 0.18;
     }},
    {"fixed ball that moves",
     [](Scene& scene) {
       add_fixed_mover(scene, {-0.5, 0, 0}, Vec3::Zero());
     }},
    {"fixed ball that rotates, with contacts by projection",
     [](Scene& scene) {
       scene.default_interface.law = InterfaceLaw::projection;
       add_fixed_mover(scene, Vec3::Zero(), {0, 20, 5});
       add_other_ball(scene);
     }},
    {"ball and piston", add_piston},
    {"ball and piston that rotates", add_rotating_piston},
    {"ball and piston in two dimensions",
     [](Scene& scene) {
       add_piston(scene);
       set_plane(scene);
     }},
};

// See physics/IncompressibleDevice.HasTheAccuracyOfTheCpu. Collisions of particles amplify
// differences by rounding in later steps.
constexpr std::uint32_t kAccurateSteps = 15;

void expect_accuracy(std::span<const SceneCase> cases, std::uint32_t steps = kAccurateSteps) {
  constexpr Real kRatio = 4;
  Scene scene = make_incompressible_pool();
  scene.incompressible.divergence_tolerance = 1e-7;
  expect_accuracy_of_cpu(scene, cases, steps, kRatio);
}

TEST(IncompressibleSolidsDevice, HasTheAccuracyOfTheCpuWithRigidBodies) {
  expect_accuracy(kRigidScenes);
}

TEST(IncompressibleSolidsDevice, HasTheAccuracyOfTheCpuWithDeformableBodies) {
  expect_accuracy(kDeformableScenes);
}

TEST(IncompressibleSolidsDevice, HasTheAccuracyOfTheCpuWithGuidedBodies) {
  expect_accuracy(kGuidedScenes);
}

TEST(IncompressibleSolidsDevice, HasTheAccuracyOfTheCpuWithIncompleteLists) {
  constexpr std::uint32_t kSteps = 4;
  const SceneCase cases[] = {{"more neighbours than a list has", [](Scene& scene) {
                                scene.materials[0].liquid->support_radius = 4.2 * kPoolSpacing;
                              }}};
  expect_accuracy(cases, kSteps);
}

// Archimedes: draft / height is the density ratio. The tolerance is that of case INT-1i.
TEST(IncompressibleSolidsDevice, FloatsABoxAtItsDraft) {
  const Scene scene = make_floating_box(PressureSolver::incompressible, 2.5e-3, 0.5);
  EXPECT_NEAR(find_draft(scene), 0.5, 0.02);
}

// The solve of the device is that of the CPU, so that rounding alone changes the iterations. A
// residual that is close to a limit can need one iteration more or less.
TEST(IncompressibleSolidsDevice, TakesTheIterationsOfTheCpu) {
  constexpr std::uint32_t kSteps = 30;
  constexpr Real kClose = 0.1 * kSteps;
  Scene scene = make_incompressible_pool();
  add_wet_jelly(scene);
  for (const Real density : {500, 20}) {
    scene.materials[1].density = density;
    Simulation device = make_on_device(scene);
    Simulation cpu = make_simulation(scene);
    const IterationCounts counts = device.advance(kSteps).iterations;
    const IterationCounts expected = cpu.advance(kSteps).iterations;
    EXPECT_GT(expected.velocities, 2 * kSteps);
    EXPECT_NEAR(static_cast<Real>(counts.velocities), static_cast<Real>(expected.velocities),
                kClose);
  }
}

// Shifts of positions change the angular momentum, as on the CPU.
TEST(IncompressibleSolidsDevice, ConservesMomentum) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    const Simulation device = expect_momentum_of_splash(PressureSolver::incompressible, kind);
    Simulation cpu = make_simulation(make_splash(PressureSolver::incompressible, kind));
    const Real scale = motion_of(cpu).angular_momentum;
    cpu.advance(100);
    const Vec3 difference = totals_of(device.diagnostics()).angular_momentum -
                            totals_of(cpu.diagnostics()).angular_momentum;
    EXPECT_LT(difference.norm(), kRoundingOfMomentum * scale);
  }
}

// Held bodies rest exactly. Each step has one rounding error of the position of a driven body.
TEST(IncompressibleSolidsDevice, GuidesBodies) {
  constexpr std::uint32_t kSteps = 20;
  Scene scene = make_incompressible_pool();
  add_piston(scene);
  BodyDescription& ball = scene.bodies[1];
  ball.release = kSteps * scene.numerics.step;
  ball.position.z() = 0.12;
  ball.velocity.setZero();
  ball.angular_velocity.setZero();
  Simulation device = make_on_device(scene);
  const Vec3 start = device.bodies()[1].pose->center_of_mass;
  EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
  EXPECT_EQ(device.bodies()[1].pose->center_of_mass, start);
  Simulation cpu = make_simulation(scene);
  cpu.advance(kSteps);
  const RigidPose pose = *device.bodies()[2].pose;
  const RigidPose expected = *cpu.bodies()[2].pose;
  const Real rounding = kSteps * 0x1p-52;
  EXPECT_GT((expected.center_of_mass - scene.bodies[2].position).norm(), 1e-3);
  EXPECT_LT((pose.center_of_mass - expected.center_of_mass).norm(), rounding);
  EXPECT_LT((pose.velocity - expected.velocity).norm(), rounding);
  device.advance(1);
  EXPECT_NE(device.bodies()[1].pose->velocity, Vec3::Zero());
}

TEST(IncompressibleSolidsDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_incompressible_pool();
  add_piston(scene);
  add_wet_jelly(scene);
  expect_same_bits_in_any_portions(scene, 2);
}

TEST(IncompressibleSolidsDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_incompressible_pool();
  add_piston(scene);
  add_wet_jelly(scene);
  expect_continuation(scene, 4, 1e-2 * kPoolSpacing);
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(IncompressibleSolidsDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Scene scene = make_incompressible_pool();
  add_piston(scene);
  add_wet_jelly(scene);
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(30).device_steps, 30U);
  EXPECT_EQ(device.state_hash(), 0x70aacd1eb80cbe9U);
}

TEST(IncompressibleSolidsDevice, TakesTheStepsOfTheCatalogue) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/deep-tank.json");
  Simulation device = make_on_device(scene.value());
  EXPECT_EQ(device.advance(80).device_steps, 80U);
  EXPECT_EQ(device.state_hash(), 0xb0ae91be1ea7afc2U);
}

TEST(IncompressibleSolidsDevice, LeavesAFailedStepToTheCpu) {
  Scene scene = make_incompressible_pool();
  scene.bodies[1].velocity = {0, 0, 15};  // the greatest speed is 10 m/s
  scene.bodies[1].position.z() = 0.3;
  expect_steps_of_cpu(scene, 2);
}

TEST(IncompressibleSolidsDevice, RestoresTheStateBeforeAFailedStep) {
  Scene scene = make_incompressible_pool();
  scene.bodies[1].position.z() = 3;
  scene.bodies[1].velocity = {0, 0, -9.985};
  scene.bodies[1].angular_velocity.setZero();
  scene.vat->max.z() = 8;
  expect_restored_state(scene, 1, 2);
}

TEST(IncompressibleSolidsDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/bodies/1/axle",
       [](Scene& s) {
         s.bodies[1].axle = Axle{{0, 0, 1}};
         s.bodies[1].velocity.setZero();
         s.bodies[1].angular_velocity.setZero();
       }},
      {"/default_interface",
       [](Scene& s) {
         add_piston(s);
         s.default_interface.law = InterfaceLaw::projection;
       }},
      {"/numerics/step", [](Scene& s) { s.materials[0].liquid->viscosity = 200; }},
      {"/numerics/control",
       [](Scene& s) {
         add_wet_jelly(s);
         s.numerics.control = StepControl::adaptive;
       }},
  };
  expect_refusals(make_incompressible_pool(), cases);
}

}  // namespace
}  // namespace vat::device_incompressible_solids_test
