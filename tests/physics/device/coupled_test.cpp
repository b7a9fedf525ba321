#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/scenes.h"

// Moving solids in weakly compressible liquids on an OpenCL device.

namespace vat::device_coupled_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

BodyDescription make_solid(const char* name, BodyKind kind, const char* material,
                           const Shape& shape, const Vec3& position,
                           const Vec3& velocity = Vec3::Zero()) {
  BodyDescription body{name, kind, material, shape, kSpacing};
  body.position = position;
  body.velocity = velocity;
  return body;
}

/// A collapsing column of water, and a ball that falls on it, near a wall of the vat.
Scene make_pool() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {400, 0.01, 2 * kSpacing}),
                     make_material("wood", 500)};
  scene.materials[0].liquid->artificial_viscosity = 0.1;
  scene.default_interface = {1000, 0.2};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.08}, {0.16, 0.12, 0.16}}, kSpacing},
                  make_solid("ball", BodyKind::rigid, "wood", SphereShape{Vec3::Zero(), 0.03},
                             {0.035, 0.06, 0.2}, {-0.2, 0, -1})};
  scene.bodies[1].angular_velocity = {2, 5, -1};
  return scene;
}

/// Adds a plate beside the column, which moves towards it.
void add_piston(Scene& scene) {
  scene.bodies.push_back(make_solid("piston", BodyKind::rigid, "wood",
                                    BoxShape{Vec3::Zero(), {0.04, 0.12, 0.2}}, {0.19, 0.06, 0.1}));
  scene.bodies.back().motion = SlideMotion{{-1, 0, 0.1}, 0.04, 0.2};
}

/// Adds a ball that collides with the first one.
void add_other_ball(Scene& scene) {
  scene.bodies.push_back(make_solid("other ball", BodyKind::rigid, "wood",
                                    SphereShape{Vec3::Zero(), 0.03}, {0.1, 0.06, 0.2},
                                    {-1.5, 0, -1}));
}

/// Adds a block of jelly that falls into the water beside the ball.
void add_jelly(Scene& scene) {
  Material jelly = make_material("jelly", 500);
  jelly.springs = LatticeSprings{SpringConstants{200, 0.05}, SpringConstants{100, 0.02},
                                 SpringConstants{50, 0}};
  jelly.self_contact = SpringConstants{500, 0.1};
  scene.materials.push_back(jelly);
  scene.bodies.push_back(make_solid("jelly", BodyKind::deformable, "jelly",
                                    BoxShape{Vec3::Zero(), {0.08, 0.06, 0.06}}, {0.115, 0.06, 0.2},
                                    {-0.5, 0.2, -1}));
}

void set_plane(Scene& scene) {
  scene.dimensions = 2;
  std::get<BoxShape>(scene.bodies[0].shape).center.y() = 0;
  for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
    scene.bodies[b].position.y() = 0;
    scene.bodies[b].velocity.y() = 0;
    scene.bodies[b].angular_velocity = {0, scene.bodies[b].angular_velocity.y(), 0};
  }
  scene.vat->min.y() = -1;
  scene.vat->max.y() = 1;
}

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
    {"ball with contacts by projection",
     [](Scene& scene) { scene.default_interface.law = InterfaceLaw::projection; }},
    {"piston", add_piston},
    {"piston in two dimensions",
     [](Scene& scene) {
       add_piston(scene);
       set_plane(scene);
     }},
    {"fixed bodies",
     [](Scene& scene) {
       scene.bodies.push_back(
           make_fixed("sill", BoxShape{{0.22, 0.06, 0.02}, {0.04, 0.12, 0.04}}, kSpacing));
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
    {"jelly and ball", add_jelly},
    {"only jelly, in a sliding vat",
     [](Scene& scene) {
       add_jelly(scene);
       scene.bodies.erase(scene.bodies.begin() + 1);
       scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
     }},
    {"jelly with a bulk modulus",
     [](Scene& scene) {
       add_jelly(scene);
       scene.materials[2].bulk_modulus = 2000;
     }},
    {"jelly with implicit springs",
     [](Scene& scene) {
       add_jelly(scene);
       scene.materials[2].implicit_springs = true;
     }},
    {"plastic jelly",
     [](Scene& scene) {
       add_jelly(scene);
       scene.materials[2].plasticity = Plasticity{.yield_strain = 0};
     }},
    {"jelly and piston in two dimensions",
     [](Scene& scene) {
       add_jelly(scene);
       add_piston(scene);
       set_plane(scene);
     }},
    {"jelly at no-slip walls that move",
     [](Scene& scene) {
       add_jelly(scene);
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
  add_jelly(scene);
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

/// A pool in two dimensions, which settles until 0.6 s around a flat box of this density ratio at
/// its draft, h * ratio.
Scene make_floating_box(Real ratio, Real width, Real height) {
  constexpr Real kLattice = 0.025;
  constexpr Real kDepth = 12 * kLattice;
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.02 / 13);
  scene.dimensions = 2;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {343, 10, 3 * kLattice}),
                     make_material("wood", 1000 * ratio)};
  scene.settling = Settling{53, 0.6};
  scene.vat = Vat{{0, -1, 0}, {width, 1, 2}, false, {}};
  const Vec3 center(width / 2, 0, kDepth + height * (0.5 - ratio));
  const Vec3 half(5 * kLattice, 1, height / 2);
  std::vector<Vec3> water;
  for (const Vec3& point : make_lattice(28, 1, 12, kLattice)) {
    const Vec3 at = point + Vec3(width / 2, 0, kDepth / 2);
    const Vec3 beyond = (at - center).cwiseAbs() - half - Vec3::Constant(kLattice / 2);
    if (beyond.maxCoeff() > 0) water.push_back(at);
  }
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water",
                make_particles(water, 1000 * kLattice * kLattice), kLattice / 2),
      make_solid("box", BodyKind::rigid, "wood", BoxShape{Vec3::Zero(), 2 * half}, center)};
  scene.bodies[1].spacing = kLattice;
  return scene;
}

// Archimedes: draft / height is the density ratio. The tolerance is that of case INT-1-tait.
TEST(CoupledDevice, FloatsBoxesAtTheirDraft) {
  constexpr Real kWidth = 0.7;
  constexpr Real kHeight = 0.15;
  constexpr std::uint32_t kStepsOfSample = 13;  // 0.02 s
  for (const Real ratio : {0.25, 0.5, 0.75}) {
    Simulation device = make_on_device(make_floating_box(ratio, kWidth, kHeight));
    EXPECT_EQ(device.advance(50 * kStepsOfSample).device_steps, 50 * kStepsOfSample);
    Real sum = 0;
    constexpr int kSamples = 20;
    for (int n = 0; n < kSamples; ++n) {
      device.advance(kStepsOfSample);
      const Diagnostics now = device.diagnostics();
      const Real level = (now.bodies[0].mass + now.bodies[1].mass) / 1000 / kWidth;
      sum += (level - now.bodies[1].center_of_mass.z() + kHeight / 2) / kHeight;
    }
    EXPECT_NEAR(sum / kSamples, ratio, 0.01);
  }
}

/// A block of liquid that meets a rigid or deformable one, without gravity and vat.
Scene make_splash(BodyKind kind) {
  Scene scene = make_collision(BodyKind::liquid, kind, IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  return scene;
}

// The sums of forces in single precision have up to 64 terms with one rounding error each.
void expect_conservation(BodyKind kind) {
  constexpr Real kRounding = 64 * 0x1p-23;
  Simulation device = make_on_device(make_splash(kind));
  const MomentumWatch watch(device);
  const Vec3 start = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_EQ(device.advance(100).device_steps, 100U);
  const Vec3 end = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_GT((end - start).norm(), 0.1 * start.norm());
  watch.expect_momentum(kRounding);
  watch.expect_angular_momentum(kRounding);
}

TEST(CoupledDevice, ConservesMomentumWithARigidBody) {
  expect_conservation(BodyKind::rigid);
}

TEST(CoupledDevice, ConservesMomentumWithADeformableBody) {
  expect_conservation(BodyKind::deformable);
}

TEST(CoupledDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  Scene scene = make_pool();
  add_piston(scene);
  add_jelly(scene);
  expect_same_bits_in_any_portions(scene, 4);
}

TEST(CoupledDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  Scene scene = make_pool();
  add_piston(scene);
  add_jelly(scene);
  expect_continuation(scene, 20, 1e-4 * kSpacing);
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
  const SceneCase cases[] = {{"ball", [](Scene&) {}}, {"jelly and ball", add_jelly}};
  expect_accuracy_with_other_integrators(make_pool(), cases, 40);
}

TEST(CoupledDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/bodies/1/velocity", [](Scene& s) { s.bodies[1].release = 1; }},
      {"/bodies/1/axle",
       [](Scene& s) {
         s.bodies[1].axle = Axle{{0, 0, 1}};
         s.bodies[1].velocity.setZero();
         s.bodies[1].angular_velocity.setZero();
       }},
      {"/bodies/2/angular_velocity",
       [](Scene& s) {
         add_piston(s);
         s.bodies[2].angular_velocity = {0, 0, 1};
       }},
      {"/default_interface",
       [](Scene& s) { s.default_interface.law = InterfaceLaw::lennard_jones; }},
  };
  expect_refusals(make_pool(), cases);
}

}  // namespace
}  // namespace vat::device_coupled_test
