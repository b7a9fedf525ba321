#include "server/cli/simulate_schedule.h"

#include <gtest/gtest.h>

#include "core/limits.h"

namespace vat::schedule_test {
namespace {

TEST(Schedule, KeepsAStepThatDividesTheInterval) {
  for (const Real step : {1e-3, 1.0 / 3000, 0.0001, 0.007}) {
    for (const int count : {1, 3, 10, 12345}) {
      const Schedule schedule = make_schedule(step, step * count, step * count * 2);
      EXPECT_EQ(schedule.step, step);
      EXPECT_EQ(schedule.steps_per_output, static_cast<std::uint64_t>(count));
      EXPECT_EQ(schedule.output_count(), 3u);
      EXPECT_TRUE(schedule.notices.empty());
    }
  }
}

TEST(Schedule, NeverLengthensTheStep) {
  for (const Real every : {0.00999, 0.0101, 0.5, 0.0005, 1e-6}) {
    const Schedule schedule = make_schedule(1e-3, every, 0);
    EXPECT_LE(schedule.step, 1e-3) << every;
    EXPECT_DOUBLE_EQ(schedule.step * static_cast<Real>(schedule.steps_per_output), every);
  }
}

TEST(Schedule, ShortensTheStepUntilItMeetsTheEndToo) {
  struct Case {
    Real every, until, step;
  };
  for (const Case& c : {Case{0.3, 1, 0.1 / 100}, Case{0.02, 0.0505, 0.0005},
                        Case{0.007, 0.01, 0.001}, Case{0.0104, 0.02, 0.0008}}) {
    const Schedule schedule = make_schedule(1e-3, c.every, c.until);
    EXPECT_DOUBLE_EQ(schedule.step, c.step) << c.every << ' ' << c.until;
    EXPECT_DOUBLE_EQ(schedule.step * static_cast<Real>(schedule.total_steps), c.until);
  }
}

TEST(Schedule, CountsTheOutputAtTheEndOnce) {
  EXPECT_EQ(make_schedule(0.1, 0.2, 0).output_count(), 1u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.1).output_count(), 2u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.2).output_count(), 2u);
  EXPECT_EQ(make_schedule(0.1, 0.2, 0.5).output_count(), 4u);
}

TEST(Schedule, TickStaysWhereItIsAWholeNumberOfSteps) {
  const Numerics scene{.step = 1e-3, .tick = 0.02};
  EXPECT_EQ(with_step(scene, 1e-3).tick, 0.02);
  EXPECT_EQ(with_step(scene, 2e-3).tick, 0.02);
  EXPECT_DOUBLE_EQ(with_step(scene, 3e-3).tick, 0.021);
  EXPECT_DOUBLE_EQ(with_step(scene, 0.1).tick, 0.1);
  const Numerics shortest = with_step(scene, kMinStep);
  EXPECT_DOUBLE_EQ(shortest.tick, kMinStep * kMaxStepsPerTick);
}

}  // namespace
}  // namespace vat::schedule_test
