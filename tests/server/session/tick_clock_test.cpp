#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>

#include "server/session/ticks/tick_clock.h"
#include "server/session/ticks/tick_profile.h"
#include "server/support/deferred_tasks.h"
#include "server/support/stage_clock.h"
#include "tests/support/manual_clock.h"
#include "tests/support/shaken_vat.h"

namespace vat::test::tick_clock_test {
namespace {

using Clock = StageClock::Clock;
using Time = SteadyClock::time_point;
using namespace std::chrono_literals;
using std::chrono::milliseconds;

constexpr milliseconds kPeriod{20};
const Time kStart{std::chrono::hours(1)};

/// Runs due ticks of a given duration until `end`. Returns their number.
int run_until(TickClock& clock, Time end, milliseconds duration) {
  int ticks = 0;
  for (Time now = kStart; clock.due() < end; ++ticks) {
    now = std::max(now, clock.due()) + duration;
    clock.tick_done(now);
  }
  return ticks;
}

TEST(TickClock, FastTicksKeepTheSchedule) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  EXPECT_EQ(clock.due(), kStart + kPeriod);
  // Due at 20, 40, ... 980 ms: the ticks' duration of 5 ms causes no drift.
  EXPECT_EQ(run_until(clock, kStart + milliseconds(1000), milliseconds(5)), 49);
  EXPECT_EQ(clock.due(), kStart + milliseconds(1000));
}

TEST(TickClock, ATickThatIsALittleLateIsMadeUpFor) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  clock.tick_done(clock.due() + milliseconds(35));
  EXPECT_EQ(clock.due(), kStart + milliseconds(40)) << "due in the past, so it runs immediately";
  clock.tick_done(kStart + milliseconds(57));
  EXPECT_EQ(clock.due(), kStart + milliseconds(60)) << "on time again";
}

TEST(TickClock, ALongPauseIsNotMadeUpFor) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  const Time late = kStart + milliseconds(10'000);
  clock.tick_done(late);
  EXPECT_EQ(clock.due(), late - kPeriod) << "at most one period is made up";
  clock.tick_done(late);
  clock.tick_done(late);
  EXPECT_GT(clock.due(), late);
}

TEST(TickClock, ThePeriodFollowsTheSpeed) {
  for (const double speed : {0.05, 0.3, 1.0, 4.0}) {
    const std::chrono::duration<double> period = tick_period(0.02, speed);
    EXPECT_NEAR(period.count(), 0.02 / speed, 1e-9);  // resolution of the clock
  }
  EXPECT_GT(tick_period(1e-12, 4), SteadyClock::duration::zero());
}

TEST(RateMeter, MeasuresSimulatedSecondsPerSecond) {
  RateMeter meter;
  EXPECT_EQ(meter.rate(), 0);
  Time now = kStart;
  meter.tick_done(now, 0.02);
  EXPECT_EQ(meter.rate(), 0) << "one tick has no duration";
  for (int i = 0; i < 200; ++i) meter.tick_done(now += milliseconds(10), 0.02);
  EXPECT_NEAR(meter.rate(), 2, 1e-9);
  EXPECT_FALSE(meter.slower_than(2));
  EXPECT_TRUE(meter.slower_than(3));
}

TEST(RateMeter, ForgetsSamplesOlderThanItsWindow) {
  RateMeter meter;
  Time now = kStart;
  for (int i = 0; i < 200; ++i) meter.tick_done(now += milliseconds(10), 0.02);
  for (int i = 0; i < 15; ++i) meter.tick_done(now += milliseconds(100), 0.02);
  EXPECT_NEAR(meter.rate(), 0.2, 1e-9);
  for (int i = 0; i < 3; ++i) meter.tick_done(now += milliseconds(4000), 1);
  EXPECT_NEAR(meter.rate(), 0.25, 1e-9) << "ticks longer than the window";
  EXPECT_TRUE(meter.slower_than(1));
}

TEST(RateMeter, DoesNotCallTheFirstTicksSlow) {
  RateMeter meter;
  meter.tick_done(kStart, 0.02);
  meter.tick_done(kStart + milliseconds(400), 0.02);
  EXPECT_FALSE(meter.slower_than(1));
  meter.tick_done(kStart + milliseconds(800), 0.02);
  EXPECT_TRUE(meter.slower_than(1));
}

constexpr std::uint64_t kStages = 10;  // stages per tick

class TickProfileTest : public testing::Test {
 protected:
  /// Returns true if the profile sampled the tick.
  bool tick(StageClock::Clock::duration time) {
    StageObserver* observer = profile.next_observer();
    for (std::uint64_t s = 0; s < kStages && observer != nullptr; ++s) {
      observer->stage_begins("stage");
    }
    if (observer != nullptr) observer->stages_end();
    AdvanceReport report;
    report.steps = 3;
    report.undone_steps = 1;
    profile.tick_done(time, report, metrics);
    return observer != nullptr;
  }
  /// Returns the number of sampled ticks.
  int looks(int count, StageClock::Clock::duration time) {
    int looked_at = 0;
    for (int i = 0; i < count; ++i) looked_at += tick(time) ? 1 : 0;
    return looked_at;
  }

  TickProfile profile;
  ServerMetrics metrics;
};

TEST_F(TickProfileTest, CountsEveryTick) {
  looks(4, 10us);
  tick(30us);
  const TickProfile::Totals& totals = profile.totals();
  EXPECT_EQ(totals.ticks, 5U);
  EXPECT_EQ(totals.substeps, 15U);
  EXPECT_EQ(totals.undone_substeps, 5U);
  EXPECT_EQ(totals.time, 70us);
  EXPECT_EQ(totals.longest_tick, 30us);
  EXPECT_NE(metrics.to_text({}).find("vat_tick_duration_seconds_count 5\n"), std::string::npos);
}

// 10 stages of 40 ns each are half a percent of 80 us.
TEST_F(TickProfileTest, LooksAtEveryLongTick) {
  EXPECT_EQ(looks(100, 81us), 100);
  ASSERT_EQ(profile.totals().stages.size(), 1U);
  EXPECT_EQ(profile.totals().stages[0].calls, 100 * kStages);
}

TEST_F(TickProfileTest, LooksAtSomeShortTicksThatStandForTheOthers) {
  tick(8100ns);
  EXPECT_EQ(looks(100, 8100ns), 10);
  EXPECT_EQ(profile.totals().stages[0].calls, 101 * kStages);
  EXPECT_NE(metrics.to_text({}).find("vat_stage_calls_total{stage=\"stage\"} 1010\n"),
            std::string::npos);
}

TEST_F(TickProfileTest, HasTheStagesOfTheLastTickOnly) {
  tick(1us);
  EXPECT_EQ(profile.spans().size(), kStages);
  EXPECT_FALSE(tick(1us));
  EXPECT_TRUE(profile.spans().empty()) << "not sampled";
}

TEST_F(TickProfileTest, LooksAtTheShortestTicksNowAndThen) {
  tick(1ns);
  EXPECT_EQ(looks(1000, 1ns), 10);
}

TEST_F(TickProfileTest, SamplesMoreOftenDuringLongTicks) {
  looks(50, 1us);
  looks(100, 1ms);  // at least one sample
  EXPECT_EQ(looks(10, 1ms), 10);
}

/// The time of the stage clock in these tests.
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
  test_time += 500ms;  // between calls, so it belongs to no stage
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
  ASSERT_EQ(clock.spans().size(), 4U);
  EXPECT_EQ(clock.spans()[2].name, "first");
  EXPECT_EQ(clock.spans()[2].end - clock.spans()[2].begin, 10ms);
  EXPECT_EQ(clock.spans()[3].begin - clock.spans()[2].end, 500ms);
  clock.clear();
  EXPECT_TRUE(clock.spans().empty());
}

TEST(StageClock, KeepsALimitedNumberOfSpans) {
  StageClock clock(read_test_time);
  for (std::size_t s = 0; s < StageClock::kMaxSpans + 5; ++s) clock.stage_begins("stage");
  clock.stages_end();
  EXPECT_EQ(clock.spans().size(), StageClock::kMaxSpans);
  EXPECT_EQ(clock.stages()[0].calls, StageClock::kMaxSpans + 5);
}

Clock::time_point processor_time() {
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(thread_time()));
}

// The stages account for the complete call, with each step control. The clock measures the thread's
// processor time, so other processes do not affect it.
TEST(StageClock, NothingOfAStepIsLeftOut) {
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = test::make_shaken_vat(IntegratorId::velocity_verlet);
    scene.numerics.control = control;
    Simulation simulation = test::make_simulation(scene);
    StageClock clock(processor_time);
    simulation.set_observer(&clock);
    const Clock::time_point begin = processor_time();
    simulation.advance(1000);
    const std::chrono::duration<double> whole = processor_time() - begin;
    double charged = 0;
    for (const StageClock::Stage& stage : clock.stages()) charged += stage.seconds();
    EXPECT_LE(charged, whole.count()) << to_string(control);
    EXPECT_GE(charged, 0.98 * whole.count()) << to_string(control);
  }
}

// The context ends if no timer is pending.
TEST(SystemClock, TimersRunTheirTaskOnceAndInTime) {
  boost::asio::io_context io;
  SystemClock clock;
  const auto timer = clock.make_timer(io.get_executor());
  const auto due = clock.now() + 5ms;
  int runs = 0;
  timer->start(due, [&] {
    ++runs;
    EXPECT_GE(clock.now(), due);
  });
  io.run();
  EXPECT_EQ(runs, 1);
}

TEST(SystemClock, AStartReplacesTheTaskAndACancelDropsIt) {
  boost::asio::io_context io;
  SystemClock clock;
  const auto timer = clock.make_timer(io.get_executor());
  const auto other = clock.make_timer(io.get_executor());
  std::string runs;
  timer->start(clock.now() + 24h, [&] { runs += "a"; });
  timer->start(clock.now(), [&] { runs += "b"; });
  other->start(clock.now() + 24h, [&] { runs += "c"; });
  other->cancel();
  io.run();
  EXPECT_EQ(runs, "b");
}

TEST(SystemClock, WallTimeIsThatOfTheSystem) {
  const auto seconds = [] {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const double before = seconds();
  const double told = SystemClock().wall_time();
  EXPECT_LE(before, told);
  EXPECT_LE(told, seconds());
}

class DeferredTasksTest : public testing::Test {
 protected:
  ~DeferredTasksTest() override {
    tasks->stop();
    pool.join();
  }
  void add(SteadyClock::duration after, const std::string& name) {
    tasks->add(clock.now() + after, [this, name] { runs += name; });
  }

  ManualClock clock;
  boost::asio::thread_pool pool{2};
  const std::shared_ptr<DeferredTasks> tasks = std::make_shared<DeferredTasks>(pool, clock);
  std::string runs;
};

TEST_F(DeferredTasksTest, RunInTheOrderOfTheirTimes) {
  add(20ms, "c");
  add(10ms, "a");
  add(10ms, "b");
  add(30ms, "d");
  clock.advance(9ms);
  EXPECT_EQ(runs, "");
  clock.advance(1ms);
  EXPECT_EQ(runs, "ab");
  clock.advance(1h);
  EXPECT_EQ(runs, "abcd");
}

TEST_F(DeferredTasksTest, ATaskThatThrowsHoldsUpNoOther) {
  tasks->add(clock.now() + 1ms, [] { throw std::runtime_error("a fault"); });
  add(1ms, "a");
  add(2ms, "b");
  clock.advance(2ms);
  EXPECT_EQ(runs, "ab");
}

TEST_F(DeferredTasksTest, NoneRunsAfterTheStop) {
  add(10ms, "a");
  tasks->stop();
  add(10ms, "b");
  clock.advance(1h);
  EXPECT_EQ(runs, "");
  EXPECT_EQ(clock.waiting(), 0U);
}

}  // namespace
}  // namespace vat::test::tick_clock_test
