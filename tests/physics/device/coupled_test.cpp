#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/physics/device/pool.h"
#include "tests/support/scenes.h"

// Moving solids in weakly compressible liquids on an OpenCL device.

namespace vat::device_coupled_test {
namespace {

using namespace test;

const SceneCase kRigidScenes[] = {
    {"ball", [](Scene&) {}},
    {"two balls in contact in a sliding vat",
     [](Scene& scene) {
       add_other_ball(scene);
       scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
     }},
    {"ball that is held",
     [](Scene& scene) {
       scene.bodies[1].release = 1;
       scene.bodies[1].position.z() = 0.12;
       scene.bodies[1].velocity.setZero();
       scene.bodies[1].angular_velocity.setZero();
     }},
    {"ball that moves before its release",
     [](Scene& scene) {
       scene.bodies[1].release = 0.01;
       scene.bodies[1].position.z() = 0.18;
     }},
    {"fixed ball that moves",
     [](Scene& scene) {
       add_fixed_mover(scene, {-0.5, 0, 0}, Vec3::Zero());
     }},
    {"fixed ball that rotates",
     [](Scene& scene) {
       add_fixed_mover(scene, Vec3::Zero(), {0, 20, 5});
     }},
    {"ball with contacts by projection",
     [](Scene& scene) { scene.default_interface.law = InterfaceLaw::projection; }},
    {"piston", add_piston},
    {"piston that rotates", add_rotating_piston},
    {"piston in two dimensions",
     [](Scene& scene) {
       add_piston(scene);
       set_plane(scene);
     }},
    {"fixed bodies",
     [](Scene& scene) {
       scene.bodies.push_back(
           make_fixed("sill", BoxShape{{0.22, 0.06, 0.02}, {0.04, 0.12, 0.04}}, kPoolSpacing));
       scene.bodies.back().material = "wood";
     }},
    {"no-slip walls that move", set_no_slip},
    {"honey between slip walls",
     [](Scene& scene) {
       scene.materials[0].liquid->viscosity = 0.3;
       scene.materials[0].liquid->artificial_viscosity = 0;
       scene.numerics.step = scene.numerics.tick = 5e-4;
     }},
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
    {"jelly with implicit springs",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.materials[2].implicit_springs = true;
     }},
    {"plastic jelly",
     [](Scene& scene) {
       add_wet_jelly(scene);
       scene.materials[2].plasticity = Plasticity{.yield_strain = 0};
     }},
    {"jelly and piston in two dimensions",
     [](Scene& scene) {
       add_wet_jelly(scene);
       add_piston(scene);
       set_plane(scene);
     }},
    {"jelly at no-slip walls that move",
     [](Scene& scene) {
       add_wet_jelly(scene);
       set_no_slip(scene);
     }},
};

// Forces of the liquid are sums in single precision, see physics/Device.HasTheAccuracyOfTheCpu.
// Collisions of particles amplify differences by rounding in later steps.
constexpr std::uint32_t kAccurateSteps = 20;

TEST(CoupledDevice, HasTheAccuracyOfTheCpuWithRigidBodies) {
  expect_accuracy_of_cpu(make_pool(), kRigidScenes, kAccurateSteps);
}

TEST(CoupledDevice, HasTheAccuracyOfTheCpuWithDeformableBodies) {
  Scene scene = make_pool();
  scene.numerics.step = scene.numerics.tick = 2.5e-4;  // resolves the damping of the springs
  expect_accuracy_of_cpu(scene, kDeformableScenes, 2 * kAccurateSteps);
}

// The solve of the device does not include the liquid, so that the iterations differ. Both solves
// meet the tolerance.
TEST(CoupledDevice, SolvesForStrongDamping) {
  constexpr std::uint32_t kSteps = 30;
  Scene scene = make_pool();
  add_other_ball(scene);
  add_wet_jelly(scene);
  scene.default_interface = {3000, 30, 0.4};
  expect_damping_of_cpu(scene, kSteps, kSteps + 1);
}

// A driven body follows its motion exactly, with one rounding error of its position per step.
TEST(CoupledDevice, DrivesBodiesByTheirMotion) {
  constexpr std::uint32_t kSteps = 50;
  Scene scene = make_pool();
  add_piston(scene);
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
  const SlideMotion& motion = *scene.bodies[2].motion;
  const Real phase = 2 * std::numbers::pi * device.time() / motion.period;
  const Vec3 along = motion.axis.normalized();
  const RigidPose pose = *device.bodies()[2].pose;
  const Vec3 way = motion.stroke / 2 * (1 - std::cos(phase)) * along;
  const Vec3 velocity =
      motion.stroke / 2 * 2 * std::numbers::pi / motion.period * std::sin(phase) * along;
  const Real rounding = kSteps * 0x1p-52;
  EXPECT_LT((pose.center_of_mass - scene.bodies[2].position - way).norm(), rounding);
  EXPECT_LT((pose.velocity - velocity).norm(), rounding);
}

// Archimedes: draft / height is the density ratio. The tolerance is that of case INT-1-tait.
TEST(CoupledDevice, FloatsBoxesAtTheirDraft) {
  for (const Real ratio : {0.25, 0.5, 0.75}) {
    const Scene scene = make_floating_box(PressureSolver::tait, 0.02 / 13, ratio);
    EXPECT_NEAR(find_draft(scene), ratio, 0.01);
  }
}

TEST(CoupledDevice, ConservesMomentum) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    const Simulation device = expect_momentum_of_splash(PressureSolver::tait, kind);
    const Simulation start = make_simulation(make_splash(PressureSolver::tait, kind));
    const Vec3 change = totals_of(device.diagnostics()).angular_momentum -
                        totals_of(start.diagnostics()).angular_momentum;
    EXPECT_LT(change.norm(), kRoundingOfMomentum * motion_of(start).angular_momentum);
  }
}

TEST(CoupledDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_pool();
  add_piston(scene);
  add_wet_jelly(scene);
  expect_same_bits_in_any_portions(scene, 4);
}

TEST(CoupledDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_pool();
  add_piston(scene);
  add_wet_jelly(scene);
  expect_continuation(scene, 20, 1e-4 * kPoolSpacing);
}

/// Returns a state hash after steps of a scene of the catalogue.
std::uint64_t hash_of(const std::string& name, std::uint32_t steps) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/" + name + ".json");
  Simulation simulation = make_on_device(scene.value());
  EXPECT_EQ(simulation.advance(steps).device_steps, steps) << name;
  return simulation.state_hash();
}

// Each operation is rounded as IEEE 754 defines it, so that hashes are constants.
TEST(CoupledDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  EXPECT_EQ(hash_of("buoyancy", 120), 0xf68980063125d898U);
  EXPECT_EQ(hash_of("wave-tank", 60), 0x70429d0b66d5724cU);
  EXPECT_EQ(hash_of("sliding-vat-liquid", 120), 0x382dc4c3f7221d89U);
}

TEST(CoupledDevice, LeavesAFailedStepToTheCpu) {
  struct Case {
    const char* name;
    std::uint32_t steps;
    Vec3 of_liquid;
    Vec3 of_ball;
  };
  // The greatest speed is 20 m/s of the liquid, and 10 m/s of the ball.
  const Case cases[] = {{"liquid too fast", 2, {0, 0, 25}, {0, 0, 0}},
                        {"ball too fast", 2, {0, 0, 0}, {0, 0, 15}},
                        {"ball too fast after the last step", 1, {0, 0, 0}, {0, 0, -9.995}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_pool();
    scene.bodies[0].velocity = one.of_liquid;
    scene.bodies[1].velocity = one.of_ball;
    scene.bodies[1].position.z() = 0.3;
    scene.bodies[1].angular_velocity.setZero();
    expect_steps_of_cpu(scene, one.steps);
  }
}

TEST(CoupledDevice, RestoresTheStateBeforeAFailedStep) {
  Scene scene = make_pool();
  scene.bodies[1].position.z() = 3;
  scene.bodies[1].velocity = {0, 0, -9.985};
  scene.bodies[1].angular_velocity.setZero();
  scene.vat->max.z() = 8;
  expect_restored_state(scene, 1, 2);
}

TEST(CoupledDevice, HasTheAccuracyOfTheCpuWithOtherIntegrators) {
  const SceneCase cases[] = {{"ball", [](Scene&) {}}, {"jelly and ball", add_wet_jelly}};
  expect_accuracy_with_other_integrators(make_pool(), cases, 40);
}

TEST(CoupledDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/bodies/1/axle",
       [](Scene& s) {
         s.numerics.integrator = IntegratorId::heun;
         s.bodies[1].axle = Axle{{0, 0, 1}};
         s.bodies[1].velocity.setZero();
         s.bodies[1].angular_velocity.setZero();
       }},
  };
  expect_refusals(make_pool(), cases);
}

}  // namespace
}  // namespace vat::device_coupled_test
