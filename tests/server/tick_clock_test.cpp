#include "server/session/tick_clock.h"

#include <gtest/gtest.h>

namespace vat::test::tick_clock_test {
namespace {

using std::chrono::milliseconds;
using Time = SteadyClock::time_point;

constexpr milliseconds kPeriod{20};
const Time kStart{std::chrono::hours(1)};

/// Runs due ticks of a given duration until `end`; how many there were.
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
  // Due at 20, 40, ... 980 ms: no drift by the ticks' own 5 ms.
  EXPECT_EQ(run_until(clock, kStart + milliseconds(1000), milliseconds(5)), 49);
  EXPECT_EQ(clock.due(), kStart + milliseconds(1000));
}

TEST(TickClock, ATickThatIsALittleLateIsMadeUpFor) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  clock.tick_done(clock.due() + milliseconds(35));
  EXPECT_EQ(clock.due(), kStart + milliseconds(40)) << "due in the past: runs at once";
  clock.tick_done(kStart + milliseconds(57));
  EXPECT_EQ(clock.due(), kStart + milliseconds(60)) << "on time again";
}

TEST(TickClock, ALongPauseIsNotMadeUpFor) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  const Time late = kStart + milliseconds(10'000);
  clock.tick_done(late);
  EXPECT_EQ(clock.due(), late - kPeriod) << "one period is made up for";
  clock.tick_done(late);
  clock.tick_done(late);
  EXPECT_GT(clock.due(), late);
}

// No spiral: ticks of three periods run one after the other, and the delay does not grow.
TEST(TickClock, TicksSlowerThanRealTimeRunInSlowMotion) {
  TickClock clock;
  clock.start(kStart, kPeriod);
  Time now = kStart;
  for (int i = 0; i < 1000; ++i) {
    now = std::max(now, clock.due()) + 3 * kPeriod;
    clock.tick_done(now);
    EXPECT_LE(now - clock.due(), kPeriod);
  }
  // As soon as ticks are fast again there are two to make up for, not two thousand.
  int at_once = 0;
  for (; clock.due() <= now; ++at_once) clock.tick_done(now);
  EXPECT_EQ(at_once, 2);
}

TEST(TickClock, ThePeriodFollowsTheSpeed) {
  for (const double speed : {0.05, 0.3, 1.0, 4.0}) {
    const std::chrono::duration<double> period = tick_period(0.02, speed);
    EXPECT_NEAR(period.count(), 0.02 / speed, 1e-9);  // the clock's resolution
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

TEST(RateMeter, ForgetsWhatIsLongerAgoThanItsWindow) {
  RateMeter meter;
  Time now = kStart;
  for (int i = 0; i < 200; ++i) meter.tick_done(now += milliseconds(10), 0.02);
  for (int i = 0; i < 15; ++i) meter.tick_done(now += milliseconds(100), 0.02);
  EXPECT_NEAR(meter.rate(), 0.2, 1e-9);
}

TEST(RateMeter, MeasuresTicksLongerThanItsWindow) {
  RateMeter meter;
  Time now = kStart;
  for (int i = 0; i < 3; ++i) meter.tick_done(now += milliseconds(4000), 1);
  EXPECT_NEAR(meter.rate(), 0.25, 1e-9);
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

}  // namespace
}  // namespace vat::test::tick_clock_test
