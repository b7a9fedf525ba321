#include "server/stage_clock.h"

#include <gtest/gtest.h>

#include <string>

#include "server/thread_time.h"
#include "tests/support/shaken_vat.h"

namespace vat::stage_clock_test {
namespace {

using namespace std::chrono_literals;
using Clock = StageClock::Clock;

/// The time that a stage clock of these tests reads.
Clock::time_point test_time;
Clock::time_point read_test_time() {
  return test_time;
}

TEST(StageClock, ChargesEachStageUntilTheNext) {
  const std::string copy = "first";  // the same name at another address
  StageClock clock(read_test_time);
  clock.stage_begins("first");
  test_time += 20ms;
  clock.stage_begins("second");
  test_time += 1ms;
  clock.stage_begins(copy);
  test_time += 10ms;
  clock.stages_end();
  test_time += 500ms;  // between calls: no stage's
  clock.stage_begins("second");
  test_time += 2ms;
  clock.stages_end();

  ASSERT_EQ(clock.stages().size(), 2U);
  EXPECT_EQ(clock.stages()[0].name, "first");
  EXPECT_EQ(clock.stages()[0].calls, 2U);
  EXPECT_EQ(clock.stages()[0].time, 30ms);
  EXPECT_EQ(clock.stages()[1].name, "second");
  EXPECT_EQ(clock.stages()[1].calls, 2U);
  EXPECT_EQ(clock.stages()[1].time, 3ms);
}

Clock::time_point processor_time() {
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(thread_time()));
}

// All of a call is charged to some stage, with each control of the step. Processor time of the
// thread: other work on the machine takes none of it.
TEST(StageClock, NothingOfAStepIsLeftOut) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = test::make_shaken_vat(IntegratorId::velocity_verlet);
    scene.numerics.control = control;
    Simulation simulation = test::make_simulation(scene);
    StageClock clock(processor_time);
    simulation.set_observer(&clock);
    const Clock::time_point begin = processor_time();
    simulation.advance(100);
    const std::chrono::duration<double> whole = processor_time() - begin;
    double charged = 0;
    for (const StageClock::Stage& stage : clock.stages()) charged += stage.seconds();
    EXPECT_LE(charged, whole.count()) << to_string(control);
    EXPECT_GE(charged, 0.98 * whole.count()) << to_string(control);
  }
}

}  // namespace
}  // namespace vat::stage_clock_test
