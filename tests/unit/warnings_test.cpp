#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/step_limits.h"
#include "core/scene/validate.h"

namespace vat {
namespace {

std::vector<std::string> warnings_of(const Scene& scene) {
  EXPECT_TRUE(find_errors(scene).empty());
  std::vector<std::string> found;
  for (const Warning& warning : find_warnings(scene)) {
    found.push_back(warning.code + ' ' + warning.path);
  }
  return found;
}

Scene two_balls(Real distance) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "wood";
  const SphereShape ball{{0, 0, 0}, 0.1};
  scene.bodies = {{"a", BodyKind::rigid, "wood", ball, 0.05},
                  {"b", BodyKind::rigid, "wood", ball, 0.05}};
  scene.bodies[1].position = {distance, 0, 0};
  return scene;
}

/// A mass on a spring to a fixed point: omega^2 = stiffness / 1 kg.
Scene oscillator(Real stiffness, Real damping) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.bodies.resize(1);
  scene.bodies[0].name = "pair";
  scene.bodies[0].kind = BodyKind::deformable;
  scene.bodies[0].material = "m";
  scene.bodies[0].shape = ParticleShape{{{0, 0, 0}, {1, 0, 0}}, {}, {1, 1}, {0.1, 0.1}, {0}};
  scene.bodies[0].springs = {{0, 1, {stiffness, damping}, {}}};
  return scene;
}

TEST(Warnings, OfBodiesThatOverlap) {
  EXPECT_THAT(warnings_of(two_balls(0.2)), testing::IsEmpty());
  EXPECT_THAT(warnings_of(two_balls(0.12)), testing::ElementsAre("bodies_overlap /bodies/1"));
}

TEST(Warnings, OfBodiesInAWall) {
  Scene scene = two_balls(1);
  scene.vat = Vat{{-0.09, -1, -1}, {2, 1, 1}, false, {}};
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("wall_overlap /bodies/0"));
  scene.vat->min.x() = -0.1;  // touches
  EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
}

TEST(Warnings, OfASupportRadiusThatDoesNotFitTheSpacing) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "water";
  scene.materials[0].liquid = LiquidConstants{100, 1, 0.1};
  scene.bodies = {{"pool", BodyKind::liquid, "water", BoxShape{{0, 0, 0}, {1, 1, 1}}, 0.05}};
  EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
  scene.bodies[0].spacing = 0.1;
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("support_radius /bodies/0/spacing"));
}

TEST(Warnings, OfADeformableBodyWithoutSprings) {
  Scene scene = two_balls(1);
  scene.bodies[0].kind = BodyKind::deformable;
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("no_springs /bodies/0"));
}

TEST(Warnings, OfAStepBeyondTheSpringsLimit) {
  // The bound is omega^2 <= 2 k / m, so at dt = 1 ms Verlet is safe up to k = 2 m / dt^2 = 2e6.
  EXPECT_THAT(warnings_of(oscillator(1.99e6, 0)), testing::IsEmpty());
  EXPECT_THAT(warnings_of(oscillator(2.01e6, 0)),
              testing::ElementsAre("unstable_step /numerics/step"));
}

TEST(Warnings, OfIntegratorsThatMakeUndampedSpringsGrow) {
  Scene scene = oscillator(100, 0);
  scene.numerics.integrator = IntegratorId::heun;
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("unstable_step /numerics/step"));
  EXPECT_THAT(warnings_of(oscillator(100, 0)), testing::IsEmpty());
  scene.bodies[0].springs[0].constants.damping = 1;
  EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
}

TEST(Warnings, OfStiffContacts) {
  Scene scene = two_balls(1);
  scene.bodies[0].mass = scene.bodies[1].mass = 1;
  // omega^2 = k / mu with mu = 1/2: dt = 1 ms is stable up to k = 4 mu / dt^2 = 2e6.
  scene.interfaces = {{{"wood", "wood"}, {1.99e6, 0}, {}}};
  EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
  scene.interfaces[0].constants.stiffness = 2.01e6;
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("unstable_step /numerics/step"));
}

TEST(Warnings, OfSoundAndViscosityBeyondTheStep) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].name = "water";
  scene.bodies = {{"pool", BodyKind::liquid, "water", BoxShape{{0, 0, 0}, {1, 1, 1}}, 0.05}};
  // c dt / h <= 0.96: c <= 96 m/s with h = 0.1 m and dt = 1 ms.
  scene.materials[0].liquid = LiquidConstants{95.0 * 95, 1, 0.1};
  EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
  scene.materials[0].liquid->stiffness = 97.0 * 97;
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("unstable_step /numerics/step"));
  // nu dt / h^2 <= 0.126: mu <= 1260 Pa s.
  scene.materials[0].liquid = LiquidConstants{100, 1270, 0.1};
  EXPECT_THAT(warnings_of(scene), testing::ElementsAre("unstable_step /numerics/step"));
}

}  // namespace
}  // namespace vat
