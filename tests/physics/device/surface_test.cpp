#include <gtest/gtest.h>

#include "protocol/scene/scene_json.h"
#include "tests/physics/device/on_device.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/scenes.h"

// Surface tension of weakly compressible liquids on an OpenCL device.

namespace vat::device_surface_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;

/// A box of water that contracts to a drop, and falls towards the floor of a vat.
Scene make_box() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -1};
  LiquidConstants water{4, 0.1, 2.5 * kSpacing};
  water.surface_tension = 0.5;
  scene.materials = {make_liquid("water", 1000, water)};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"box", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.06}, {0.16, 0.12, 0.12}}, kSpacing}};
  scene.bodies[0].jitter = 0.1;
  return scene;
}

/// The box without a vat, with a rotation.
Scene make_free_box() {
  Scene scene = make_box();
  scene.vat.reset();
  scene.gravity = {0, 0, 0};
  VectorField field;
  field.center = std::get<BoxShape>(scene.bodies[0].shape).center;
  field.gradient << 0, -1, 0.5, 1, 0, 0, -0.5, 0, 0;
  scene.bodies[0].velocity_field = field;
  return scene;
}

void set_angle(Scene& scene, Real angle) {
  scene.interfaces = {{{"water", kVatMaterial}, {}, {}, angle}};
}

/// The box with cohesion. Its particles need more neighbours.
Scene make_cohesive_box() {
  Scene scene = make_box();
  scene.surface_model = SurfaceModel::cohesion;
  scene.materials[0].liquid->support_radius = 3 * kSpacing;
  return scene;
}

/// Adds a ball beside the box, which the liquid wets.
void add_wet_ball(Scene& scene, bool is_fixed) {
  scene.materials.push_back(make_material("stone", 2000));
  scene.interfaces = {{{"water", "stone"}, {}, {}, 40}};
  scene.bodies.push_back(make_fixed("ball", SphereShape{{0.19, 0.06, 0.06}, 0.03}, kSpacing));
  scene.bodies[1].fixed = is_fixed;
}

const SceneCase kCohesiveScenes[] = {
    {"wet walls in a sliding vat",
     [](Scene& scene) {
       set_angle(scene, 40);
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0), 0.1, 0.2};
     }},
    {"walls that are hard to wet, with a lid",
     [](Scene& scene) {
       set_angle(scene, 130);
       scene.vat->lid = true;
       scene.vat->max.z() = 0.12;
     }},
    {"fixed ball", [](Scene& scene) { add_wet_ball(scene, true); }},
    {"free ball", [](Scene& scene) { add_wet_ball(scene, false); }},
};

const SceneCase kScenes[] = {
    {"wet walls in a sliding vat",
     [](Scene& scene) {
       set_angle(scene, 80);
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0), 0.1, 0.2};
     }},
    {"walls that are hard to wet, with a lid",
     [](Scene& scene) {
       set_angle(scene, 140);
       scene.vat->lid = true;
       scene.vat->max.z() = 0.12;
     }},
    {"adaptive steps",
     [](Scene& scene) {
       scene.numerics.control = StepControl::adaptive;
       scene.numerics.step = scene.numerics.tick = 0.02;
     }},
};

// Both compute sums over pairs in single precision. Rounding errors grow as the square root of the
// number of terms. The CPU has up to 16 partial sums of the 80 neighbours, so that its errors can
// be 4 times smaller. One further error is that of positions.
TEST(SurfaceDevice, HasTheAccuracyOfTheCpu) {
  constexpr std::uint32_t kSteps = 30;
  constexpr Real kRatio = 5;
  expect_accuracy_of_cpu(make_box(), kCommonScenes, kSteps, kRatio);
  expect_accuracy_of_cpu(make_box(), kScenes, kSteps, kRatio);
  const SceneCase free[] = {{"free drop", [](Scene&) {}}};
  expect_accuracy_of_cpu(make_free_box(), free, kSteps, kRatio);
}

// The CPU computes cohesion in double precision. The attraction, 150 Pa, is small compared with the
// stiffness, 4000 Pa, so that the rounding errors of pressures remain the greatest ones.
TEST(SurfaceDevice, HasTheAccuracyOfTheCpuWithCohesion) {
  constexpr std::uint32_t kSteps = 30;
  constexpr Real kRatio = 5;
  expect_accuracy_of_cpu(make_cohesive_box(), kCommonScenes, kSteps, kRatio);
  expect_accuracy_of_cpu(make_cohesive_box(), kCohesiveScenes, kSteps, kRatio);
}

void expect_conservation(const Scene& scene, Real tolerance) {
  constexpr std::uint32_t kSteps = 100;
  Simulation device = make_on_device(scene);
  const MomentumWatch watch(device);
  EXPECT_EQ(device.advance(kSteps).device_steps, kSteps);
  watch.expect_momentum(tolerance);
  watch.expect_angular_momentum(tolerance);
}

// Pressure and attraction are two sums in single precision of up to 80 terms with one rounding
// error each. The curvature forces are balanced for any errors.
TEST(SurfaceDevice, ConservesMomentumAndAngularMomentumOfADrop) {
  expect_conservation(make_free_box(), 2 * 80 * 0x1p-23);
}

// The sum of cohesion has up to 900 terms.
TEST(SurfaceDevice, ConservesMomentumAndAngularMomentumOfADropOnABall) {
  Scene scene = make_cohesive_box();
  add_wet_ball(scene, false);
  scene.vat.reset();
  scene.gravity = {0, 0, 0};
  scene.bodies[0].velocity = {0.3, 0, 0.1};
  expect_conservation(scene, 900 * 0x1p-23);
}

TEST(SurfaceDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_free_box(), 2);
  Scene cohesive = make_cohesive_box();
  add_wet_ball(cohesive, false);
  expect_same_bits_in_any_portions(cohesive, 1);
}

TEST(SurfaceDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  expect_continuation(make_box(), 20, 1e-4 * kSpacing);
}

// Each operation is rounded as IEEE 754 defines it, so that hashes are constants.
TEST(SurfaceDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Scene wet = make_box();
  set_angle(wet, 80);
  Simulation in_vat = make_on_device(wet);
  EXPECT_EQ(in_vat.advance(60).device_steps, 60U);
  EXPECT_EQ(in_vat.state_hash(), 0xa2481ddbc509d2e6U);
  Simulation free = make_on_device(make_free_box());
  EXPECT_EQ(free.advance(60).device_steps, 60U);
  EXPECT_EQ(free.state_hash(), 0xd4d837642314e241U);
  const Result<Scene> dew = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/dew.json");
  ASSERT_TRUE(dew.ok());
  Simulation cohesive = make_on_device(dew.value());
  EXPECT_EQ(cohesive.advance(60).device_steps, 60U);
  EXPECT_EQ(cohesive.state_hash(), 0x9d0b0dc59a877b1aU);
}

}  // namespace
}  // namespace vat::device_surface_test
