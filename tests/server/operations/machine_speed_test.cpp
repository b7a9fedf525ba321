#include <gtest/gtest.h>

#include "server/operations/machine_speed.h"

namespace vat::machine_speed_test {
namespace {

TEST(MachineSpeed, IsMeasuredOnceAndCorrectsTheEstimateOfEachScene) {
  MachineSpeed speed;
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
  scene.numerics.step = 0.002;
  const Real factor = speed.real_time_factor(scene, nullptr, best_instruction_set());
  EXPECT_GT(factor, 0);
  // The same measurement: half the step costs twice as much.
  scene.numerics.step = 0.001;
  EXPECT_DOUBLE_EQ(speed.real_time_factor(scene, nullptr, best_instruction_set()), factor / 2);
}

}  // namespace
}  // namespace vat::machine_speed_test
