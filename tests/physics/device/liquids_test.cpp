#include <gtest/gtest.h>

#include <iterator>
#include <vector>

#include "tests/physics/device/column.h"

// Sums over the pairs of weakly compressible liquids on an OpenCL device, in double precision and
// of several liquids.

namespace vat::liquids_device_test {
namespace {

using namespace test;

// The difference of the CPU with single precision is greater.
TEST(LiquidsDevice, HasTheMotionOfTheCpuWithDoublePrecision) {
  constexpr std::uint32_t kSteps = 20;
  std::vector<SceneCase> cases(std::begin(kCommonScenes), std::end(kCommonScenes));
  cases.push_back({"cubic spline", [](Scene& s) { s.kernel = KernelId::cubic_spline; }});
  cases.push_back({"Heun", [](Scene& s) { s.numerics.integrator = IntegratorId::heun; }});
  cases.push_back({"no-slip walls", set_no_slip});
  cases.push_back({"moving ball in a sliding vat", [](Scene& s) {
                     add_fixed_bodies(s);
                     s.bodies[1].fixed = false;
                     s.bodies[1].velocity = {-0.5, 0, 0};
                     s.vat->motion = SlideMotion{Vec3(1, 0, 0), 0.1, 0.2};
                   }});
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_column();
    one.edit(scene);
    Simulation single = make_advanced(scene, kSteps);
    scene.pair_precision = PairPrecision::double_precision;
    expect_motion_of_cpu(scene, kSteps);
    EXPECT_GT(difference(single, make_advanced(scene, kSteps)), rounding_after(kSteps));
  }
}

/// A column of two liquids, whose particles also have different volumes.
Scene make_layers() {
  Scene scene = make_column();
  scene.materials.push_back(make_liquid("oil", 700, {500, 0.3, 2 * kColumnSpacing}));
  scene.bodies[0].shape = BoxShape{{0.08, 0.06, 0.06}, {0.16, 0.12, 0.12}};
  scene.bodies.push_back({"film", BodyKind::liquid, "oil",
                          BoxShape{{0.08, 0.06, 0.165}, {0.16, 0.12, 0.09}}, 0.9 * kColumnSpacing});
  scene.numerics.step = scene.numerics.tick = 5e-4;
  return scene;
}

/// Adds a ball that touches both liquids.
void add_ball_at_layers(Scene& scene) {
  scene.materials.push_back(make_material("stone", 2000));
  scene.bodies.push_back(make_fixed("ball", SphereShape{{0.19, 0.06, 0.13}, 0.025}, 0.01));
}

const SceneCase kLayers[] = {
    {"layers", [](Scene&) {}},
    {"inviscid layers",
     [](Scene& scene) {
       for (Material& material : scene.materials) {
         material.liquid->viscosity = material.liquid->artificial_viscosity = 0;
       }
     }},
    {"layers in two dimensions",
     [](Scene& scene) {
       set_plane_of_liquid(scene);
       std::get<BoxShape>(scene.bodies[1].shape).center.y() = 0;
     }},
    {"layers around fixed bodies in a sliding vat",
     [](Scene& scene) {
       add_ball_at_layers(scene);
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0), 0.1, 0.2};
     }},
    {"layers beside a ball that moves",
     [](Scene& scene) {
       add_ball_at_layers(scene);
       scene.bodies[2].fixed = false;
       scene.bodies[2].velocity = {-0.5, 0, 0};
     }},
    {"layers and a central field",
     [](Scene& scene) {
       scene.vat.reset();
       scene.central_field = CentralField{{0.1, 0.05, 0.2}, 12};
     }},
};

TEST(LiquidsDevice, HasTheMotionOfTheCpuWithSeveralLiquids) {
  constexpr std::uint32_t kSteps = 30;
  expect_accuracy_of_cpu(make_layers(), kLayers, kSteps);
  Scene exact = make_layers();
  exact.pair_precision = PairPrecision::double_precision;
  for (const SceneCase& one : kLayers) {
    SCOPED_TRACE(one.name);
    Scene scene = exact;
    one.edit(scene);
    expect_motion_of_cpu(scene, kSteps);
  }
}

TEST(LiquidsDevice, HaveTheSameBitsInAnyPortionsOfSteps) {
  expect_same_bits_in_any_portions(make_layers(), 4);
  Scene exact = make_layers();
  exact.pair_precision = PairPrecision::double_precision;
  expect_same_bits_in_any_portions(exact, 4);
}

}  // namespace
}  // namespace vat::liquids_device_test
