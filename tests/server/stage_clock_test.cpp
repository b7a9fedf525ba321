#include "server/stage_clock.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "tests/support/shaken_vat.h"

namespace vat::stage_clock_test {
namespace {

using namespace std::chrono_literals;
using Clock = StageClock::Clock;

double seconds_of(const StageClock& clock) {
  double sum = 0;
  for (const StageClock::Stage& stage : clock.stages()) sum += stage.seconds();
  return sum;
}

TEST(StageClock, ChargesEachStageUntilTheNext) {
  const std::string copy = "first";  // the same name at another place
  StageClock clock;
  const Clock::time_point begin = Clock::now();
  clock.stage_begins("first");
  std::this_thread::sleep_for(20ms);
  clock.stage_begins("second");
  clock.stage_begins(copy);
  std::this_thread::sleep_for(10ms);
  clock.stages_end();
  const std::chrono::duration<double> whole = Clock::now() - begin;
  std::this_thread::sleep_for(20ms);
  clock.stage_begins("second");
  clock.stages_end();

  ASSERT_EQ(clock.stages().size(), 2U);
  EXPECT_EQ(clock.stages()[0].name, "first");
  EXPECT_EQ(clock.stages()[0].calls, 2U);
  EXPECT_GE(clock.stages()[0].seconds(), 0.03);
  EXPECT_EQ(clock.stages()[1].name, "second");
  EXPECT_EQ(clock.stages()[1].calls, 2U);
  EXPECT_LE(seconds_of(clock), whole.count() + 0.01) << "what is between calls is no stage's";
}

// All of a call is charged to some stage, whatever the integrator and the control of its steps.
TEST(StageClock, NothingOfAStepIsLeftOut) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = test::make_shaken_vat(IntegratorId::velocity_verlet);
    scene.numerics.control = control;
    Simulation simulation = test::make_simulation(scene);
    StageClock clock;
    simulation.set_observer(&clock);
    const Clock::time_point begin = Clock::now();
    simulation.advance(100);
    const std::chrono::duration<double> whole = Clock::now() - begin;
    EXPECT_LE(seconds_of(clock), whole.count()) << to_string(control);
    EXPECT_GE(seconds_of(clock), 0.99 * whole.count()) << to_string(control);
  }
}

}  // namespace
}  // namespace vat::stage_clock_test
