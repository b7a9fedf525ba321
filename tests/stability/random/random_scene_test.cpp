#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <set>

#include "core/validation/validate.h"
#include "protocol/scene/scene_json.h"
#include "tests/stability/builders.h"
#include "tests/stability/random/properties.h"
#include "tests/stability/random/random_scene.h"
#include "tests/stability/random/shrink.h"

namespace vat::stability::random_scene_test {
namespace {

constexpr std::uint64_t kScenes = 30;

PropertyReport check(const Scene& scene) {
  return check_properties(scene, 0.3, 800);
}

TEST(RandomScenes, AreValidAndTheSameForTheSameSeed) {
  std::set<std::string> texts;
  std::set<BodyKind> kinds;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const Scene scene = random_scene(seed);
    EXPECT_TRUE(find_errors(scene).empty()) << seed;
    EXPECT_EQ(write_scene(scene), write_scene(random_scene(seed)));
    texts.insert(write_scene(scene).dump());
    for (const BodyDescription& body : scene.bodies) kinds.insert(body.kind);
  }
  EXPECT_EQ(texts.size(), kScenes);
  EXPECT_EQ(kinds.size(), 3U);
}

PropertyReport expect_properties(const Scene& scene) {
  PropertyReport report = check(scene);
  if (!report.fault.empty()) {
    const Scene least = shrink(
        scene, [](const Scene& s) { return !check(s).fault.empty(); }, 50);
    ADD_FAILURE() << scene.name << ": " << report.fault
                  << "\nthe smallest scene found: " << write_scene(least).dump();
  }
  return report;
}

TEST(RandomScenes, KeepTheirProperties) {
  std::size_t with_contacts = 0;
  std::size_t with_budget = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const PropertyReport report = expect_properties(random_scene(seed));
    with_contacts += report.contact_energy > 0 ? 1 : 0;
    with_budget += report.has_momentum_budget ? 1 : 0;
  }
  EXPECT_GT(with_contacts, kScenes / 2);
  EXPECT_GT(with_budget, kScenes / 5);
}

TEST(RandomScenes, KeepTheirPropertiesWithSubSteps) {
  std::size_t with_contacts = 0;
  std::size_t supported = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const std::optional<Scene> scene = with_sub_steps(random_scene(seed));
    if (!scene) continue;
    ++supported;
    with_contacts += expect_properties(*scene).contact_energy > 0 ? 1 : 0;
  }
  EXPECT_GT(supported, kScenes / 3);
  EXPECT_GT(with_contacts, supported / 2);
}

// A scene fails as long as it has a rigid body that moves.
TEST(Shrinking, KeepsTheCauseOfAFailure) {
  Scene scene = make_tank();
  scene.vat->motion = SlideMotion{Vec3::UnitX(), 0.1, 1};
  for (int b = 0; b < 4; ++b) {
    BodyDescription body =
        make_block("body " + std::to_string(b), kKinds[b % 3], 2, {0.2 + 0.2 * b, 0.5, 0.5});
    body.shape = BoxShape{Vec3::Zero(), Vec3::Constant(4 * kSpacing)};
    body.springs.clear();
    body.velocity = {1, 0, 0};
    scene.bodies.push_back(body);
  }
  ASSERT_TRUE(find_errors(scene).empty());
  const Scene least = shrink(scene, [](const Scene& s) {
    return s.vat->motion && s.bodies.back().kind == BodyKind::rigid;
  });
  ASSERT_EQ(least.bodies.size(), 1U);
  EXPECT_EQ(least.bodies[0].kind, BodyKind::rigid);
  EXPECT_EQ(std::get<BoxShape>(least.bodies[0].shape).size, Vec3(Vec3::Constant(kSpacing)));
  EXPECT_EQ(least.bodies[0].velocity, Vec3(Vec3::Zero()));
  EXPECT_EQ(least.gravity, Vec3(Vec3::Zero()));
  EXPECT_TRUE(least.interfaces.empty());
  EXPECT_TRUE(least.vat->motion);
}

}  // namespace
}  // namespace vat::stability::random_scene_test
