#include "server/operations/scene_speed.h"

#include <gtest/gtest.h>

namespace vat::scene_speed_test {
namespace {

Scene pool_with_step(Real step) {
  Scene scene;
  Material water;
  water.name = "water";
  water.liquid = LiquidConstants{100, 0.1, 0.1, 0.1};
  scene.materials = {water};
  BodyDescription pool;
  pool.name = "pool";
  pool.material = "water";
  pool.shape = BoxShape{Vec3::Zero(), {1, 1, 1}};
  pool.spacing = 0.1;
  scene.bodies = {pool};
  scene.numerics.step = step;
  return scene;
}

TEST(SceneSpeed, MeasuresTheFirstLevelAndDerivesTheOthersFromTheEstimates) {
  const std::vector<Scene> levels{pool_with_step(0.004), pool_with_step(0.002),
                                  pool_with_step(0.001)};
  std::vector<Real> measured_steps;
  const std::vector<Real> factors = real_time_factors(levels, [&](const Scene& scene) {
    measured_steps.push_back(scene.numerics.step);
    return 0.125;
  });
  EXPECT_EQ(measured_steps, std::vector<Real>{0.004});
  ASSERT_EQ(factors.size(), 3U);
  EXPECT_DOUBLE_EQ(factors[0], 8);
  EXPECT_DOUBLE_EQ(factors[1], 4);
  EXPECT_DOUBLE_EQ(factors[2], 2);
  EXPECT_TRUE(real_time_factors({}, [](const Scene&) -> Real { throw "measured"; }).empty());
}

TEST(SceneSpeed, TheCostPerSimulatedSecondGrowsWithTheNumberOfSteps) {
  const auto cost = [](Real step) {
    return measure_cost(pool_with_step(step), nullptr, best_instruction_set());
  };
  // A factor of 100, so that delays by other programs do not matter.
  EXPECT_GT(cost(0.00004), cost(0.004));
}

}  // namespace
}  // namespace vat::scene_speed_test
