#include "server/session/tick_profile.h"

#include <gtest/gtest.h>

namespace vat::tick_profile_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kStages = 10;  // a tick of these tests

class TickProfileTest : public testing::Test {
 protected:
  /// True where the tick was looked at.
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
  /// Of `count` ticks, how many were looked at.
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

// 10 stages at 40 ns are half a percent of 80 us.
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

TEST_F(TickProfileTest, LooksAtTheShortestTicksNowAndThen) {
  tick(1ns);
  EXPECT_EQ(looks(1000, 1ns), 10);
}

TEST_F(TickProfileTest, LooksMoreOftenWhereTicksGrowLonger) {
  looks(50, 1us);
  looks(100, 1ms);  // one look at least
  EXPECT_EQ(looks(10, 1ms), 10);
}

}  // namespace
}  // namespace vat::tick_profile_test
