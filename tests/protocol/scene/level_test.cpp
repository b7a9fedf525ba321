#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/sampling/sampling.h"
#include "core/validation/validate.h"
#include "protocol/scene/level.h"
#include "protocol/scene/scene_json.h"

namespace vat::level_test {
namespace {

Scene scene_in(int dimensions) {
  Scene scene;
  scene.name = "tank";
  scene.dimensions = dimensions;
  Material water;
  water.name = "water";
  water.liquid = LiquidConstants{100, 0.5, 0.08, 0.05};
  Material rubber;
  rubber.name = "rubber";
  rubber.springs = LatticeSprings{SpringConstants{1000, 2}, {}, {}};
  rubber.self_contact = SpringConstants{500, 3};
  rubber.bulk_modulus = 700;
  scene.materials = {water, rubber};
  scene.default_interface = {.stiffness = 800, .damping = 4, .friction = 0.3};
  scene.interfaces = {{{"water", "rubber"}, {.stiffness = 600, .damping = 5}, 0.05}};
  scene.numerics.step = 0.002;
  scene.numerics.tick = 0.02;
  BodyDescription pool;
  pool.name = "pool";
  pool.material = "water";
  pool.shape = BoxShape{Vec3::Zero(), {0.48, 0.48, 0.48}};
  pool.spacing = 0.04;
  BodyDescription block = pool;
  block.name = "block";
  block.kind = BodyKind::deformable;
  block.material = "rubber";
  block.radius = 0.03;
  block.position = {2, 0, 0};
  scene.bodies = {pool, block};
  scene.emitters = {{.name = "tap",
                     .body = "pool",
                     .position = {0, 0, 4},
                     .radius = 0.1,
                     .speed = 1,
                     .most_particles = 5000}};
  return scene;
}

class Levels : public testing::TestWithParam<std::tuple<Level, int>> {};

TEST_P(Levels, ScaleLengthsConstantsAndCounts) {
  const auto& [level, dimensions] = GetParam();
  const Scene normal = scene_in(dimensions);
  const Scene scene = at_level(normal, level).value();
  const Real f = spacing_factor(level);
  const Real stiffness = std::pow(f, dimensions - 2);
  const Real damping = std::pow(f, dimensions - 1);
  EXPECT_TRUE(find_errors(scene).empty());
  EXPECT_DOUBLE_EQ(scene.bodies[0].spacing, 0.04 * f);
  EXPECT_DOUBLE_EQ(*scene.bodies[1].radius, 0.03 * f);
  EXPECT_DOUBLE_EQ(scene.materials[0].liquid->support_radius, 0.08 * f);
  EXPECT_EQ(scene.materials[0].liquid->stiffness, 100);
  EXPECT_DOUBLE_EQ(scene.materials[1].springs->structural->stiffness, 1000 * stiffness);
  EXPECT_DOUBLE_EQ(scene.materials[1].springs->structural->damping, 2 * stiffness);
  EXPECT_DOUBLE_EQ(scene.materials[1].self_contact->damping, 3 * damping);
  EXPECT_EQ(scene.materials[1].bulk_modulus, 700);
  EXPECT_DOUBLE_EQ(scene.default_interface.stiffness, 800 * stiffness);
  EXPECT_DOUBLE_EQ(scene.default_interface.damping, 4 * damping);
  EXPECT_EQ(scene.default_interface.friction, 0.3);
  EXPECT_DOUBLE_EQ(scene.interfaces[0].constants.stiffness, 600 * stiffness);
  EXPECT_DOUBLE_EQ(*scene.interfaces[0].threshold, 0.05 * f);
  EXPECT_EQ(scene.emitters[0].most_particles, std::ceil(5000 / std::pow(f, dimensions)));
  // The step is at most f times that of normal, and a tick has a whole number of steps.
  EXPECT_LE(scene.numerics.step, 0.002 * f * (1 + 1e-9));
  EXPECT_EQ(scene.numerics.tick, 0.02);
  // 12 spacings of normal are 8, 16 or 24 spacings of the other levels.
  const Real expected = std::pow(12 / f, dimensions);
  EXPECT_NEAR(static_cast<Real>(sample_bodies(scene)[0].positions.size()), expected, 0.5);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Level, int>>& parameter) {
  const auto& [level, dimensions] = parameter.param;
  return std::string(to_string(level)) + "_in_" + std::to_string(dimensions);
}

INSTANTIATE_TEST_SUITE_P(All, Levels,
                         testing::Combine(testing::Values(Level::coarse, Level::normal, Level::fine,
                                                          Level::finest),
                                          testing::Values(2, 3)),
                         name_of);

TEST(Level, IsInTheNameOfTheScene) {
  EXPECT_EQ(at_level(scene_in(3), Level::normal).value().name, "tank");
  const std::string name = at_level(scene_in(3), Level::finest).value().name;
  EXPECT_EQ(split_level(name).scene, "tank");
  EXPECT_EQ(split_level(name).level, Level::finest);
  for (const char* other : {"tank", "tank@", "tank@huge", "tank@normal", "a@b", ""}) {
    EXPECT_EQ(split_level(other).scene, other);
    EXPECT_EQ(split_level(other).level, Level::normal);
  }
}

TEST(Level, IsRefusedForParticlesThatAreGiven) {
  struct Mistake {
    const char* path;
    void (*make)(Scene&);
  };
  const Mistake mistakes[] = {
      {"/bodies/1/shape/type",
       [](Scene& scene) {
         scene.bodies[1].shape = ParticleShape{{Vec3::Zero()}, {}, {}, {}, {}};
       }},
      {"/bodies/1/springs",
       [](Scene& scene) {
         scene.bodies[1].springs = {{0, 1, {1, 0}, {}}};
       }},
      {"/name", [](Scene& scene) { scene.name = std::string(58, 'x'); }}};
  for (const auto& [path, make] : mistakes) {
    Scene scene = scene_in(3);
    make(scene);
    const Result<Scene> refused = at_level(scene, Level::finest);
    ASSERT_FALSE(refused.ok()) << path;
    EXPECT_EQ(refused.errors()[0].path, path);
    EXPECT_TRUE(at_level(scene, Level::normal).ok());
  }
}

// Each scene of the catalogue that has levels is valid at each of them, with one exception: the
// nozzle of the vessel, which is one support radius long, does not fit into it at the level coarse.
TEST(Level, OfTheCatalogueIsValid) {
  const Catalogue catalogue = Catalogue::open(VAT_SOURCE_DIR "/protocol/scenes").value();
  int scaled = 0;
  std::string invalid;
  for (const CatalogueEntry& entry : catalogue.entries()) {
    for (const Level level : {Level::coarse, Level::fine, Level::finest}) {
      const Result<Scene> scene = at_level(*catalogue.find(entry.name), level);
      if (!scene) continue;
      ++scaled;
      const Errors errors = find_errors(scene.value());
      if (errors.empty()) continue;
      invalid += entry.name + ' ' + to_string(level) + ' ' + errors[0].path + '\n';
    }
  }
  EXPECT_GE(scaled, 60);
  EXPECT_EQ(invalid, "blood-vessel coarse /emitters/0/position\n");
}

}  // namespace
}  // namespace vat::level_test
