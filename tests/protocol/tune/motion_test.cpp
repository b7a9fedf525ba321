#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/scene/scene_json.h"
#include "protocol/tune/motion.h"

namespace vat::motion_test {
namespace {

using testing::ElementsAre;
using tune::BodyPlace;
using tune::ErrorMeasure;
using tune::LeastMotion;
using tune::Moment;
using tune::Motion;

/// One body that is at x in all respects, and a body without particles.
Moment at(Real x, Real speed = 1) {
  const Vec3 place(x, 0, 0);
  return {{BodyPlace{place, place, place}, {}}, speed};
}

Motion uniform(Real offset, std::size_t moments = 5) {
  Motion motion{at(0)};
  for (std::size_t k = 1; k < moments; ++k) motion.push_back(at(static_cast<Real>(k) + offset));
  return motion;
}

constexpr LeastMotion kNone{0, 0};

TEST(ErrorMeasure, IsTheRootMeanSquareDeviationRelativeToTheMotion) {
  const ErrorMeasure measure(uniform(0), uniform(0.001), kNone);
  // Displacements of 1, 2, 3 and 4, and deviations of 0.02.
  const Real scale = std::sqrt(30.0 / 4);
  EXPECT_NEAR(measure.bound(uniform(0.02)), 0.02 / scale, 1e-15);
  EXPECT_NEAR(measure.floor(), 0.001 / scale, 1e-15);
  EXPECT_EQ(measure.horizon(), 4u);
  EXPECT_EQ(measure.bound(uniform(0)), 0);
}

TEST(ErrorMeasure, GreatestQuantityCounts) {
  const ErrorMeasure measure(uniform(0), uniform(0), kNone);
  Motion run = uniform(0.02);
  run[2].speed = 1.5;
  EXPECT_NEAR(measure.bound(run), 0.5 / 2, 1e-15);  // of four speeds of 1
  run = uniform(0);
  run[1].bodies[0]->high.z() = 0.3;
  EXPECT_NEAR(measure.bound(run), 0.3 / std::sqrt(2 * 30.0), 1e-15);
  run = uniform(0);
  run[1].bodies[0]->center.z() = 0.3;
  EXPECT_NEAR(measure.bound(run), 0.3 / std::sqrt(30.0), 1e-15);
}

TEST(ErrorMeasure, BoundsIncreaseToTheError) {
  const ErrorMeasure measure(uniform(0), uniform(0), kNone);
  const Motion run = uniform(0.02);
  Real before = 0;
  for (std::size_t k = 1; k <= run.size(); ++k) {
    const Real bound = measure.bound(std::span(run).first(k));
    EXPECT_GE(bound, before);
    before = bound;
  }
  EXPECT_EQ(before, measure.bound(run));
  EXPECT_EQ(measure.bound(std::span(run).first(1)), 0);
}

TEST(ErrorMeasure, ChaoticMomentsAreNotCompared) {
  Motion coarse = uniform(0.01);
  coarse[3] = at(5);
  const ErrorMeasure measure(uniform(0), coarse, kNone);
  EXPECT_EQ(measure.horizon(), 2u);
  Motion run = uniform(0.02);
  run[4] = at(-100);
  EXPECT_NEAR(measure.bound(run), 0.02 * std::sqrt(2.0 / 5), 1e-15);
  EXPECT_NEAR(measure.floor(), 0.01 * std::sqrt(2.0 / 5), 1e-15);
}

TEST(ErrorMeasure, FirstMomentIsAlwaysCompared) {
  const ErrorMeasure measure(uniform(0), uniform(3), kNone);
  EXPECT_EQ(measure.horizon(), 1u);
  EXPECT_NEAR(measure.floor(), 3, 1e-15);
}

TEST(ErrorMeasure, ScenesAtRestHaveALeastMotion) {
  const Motion rest(5, at(0, 0));
  const ErrorMeasure measure(rest, rest, {0.01, 0.02});
  Motion run = rest;
  run[1] = at(0.001, 0.001);
  // Two bodies and four moments.
  EXPECT_NEAR(measure.bound(run), 0.001 / std::sqrt(8 * 0.01 * 0.01), 1e-12);
  EXPECT_EQ(measure.floor(), ErrorMeasure::kLeastError);
}

TEST(Motion, ContainsFreeBodiesWithCentresAndQuantiles) {
  constexpr const char* kScene = R"({
    "format": "vat.scene/1", "gravity": [0, 0, 0],
    "materials": [{"name": "oak", "density": 500}],
    "bodies": [
      {"name": "wall", "kind": "rigid", "material": "oak", "spacing": 0.1, "fixed": true,
       "shape": {"type": "box", "size": [1, 1, 1]}, "position": [9, 0, 0]},
      {"name": "rod", "kind": "deformable", "material": "oak", "radius": 0.5,
       "velocity": [0, 3, 0],
       "shape": {"type": "particles", "masses": [1, 1, 2],
                 "positions": [[0, 0, 0], [1, 0, 0], [5, 0, 4]]}}]})";
  const Scene scene = read_scene_text(kScene, meshes_in_folder(".")).value();
  const std::vector<bool> are_free = tune::find_free_bodies(scene);
  EXPECT_THAT(are_free, ElementsAre(false, true));
  const Simulation simulation = Simulation::create(scene).value();
  const Moment moment = tune::measure(simulation, are_free);
  ASSERT_EQ(moment.bodies.size(), 1u);
  EXPECT_EQ(moment.bodies[0]->center, Vec3(2.75, 0, 2));
  EXPECT_EQ(moment.bodies[0]->low, Vec3(0, 0, 0));
  EXPECT_EQ(moment.bodies[0]->high, Vec3(5, 0, 4));
  EXPECT_NEAR(moment.speed, 3, 1e-14);
  EXPECT_GT(tune::least_motion(simulation, 2).length, 0);
}

}  // namespace
}  // namespace vat::motion_test
