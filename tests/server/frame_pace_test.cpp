#include "server/session/frame_pace.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace vat::frame_pace_test {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

using Level = std::array<unsigned, 3>;  // stride, coarseness, detail

class FramePaceTest : public testing::Test {
 protected:
  static constexpr auto kTick = 20ms;

  /// A time of frames each of which finds the viewer ready or not, with acknowledgements that come
  /// `queue` later than they could.
  void run(std::chrono::seconds time, bool is_ready, Seconds queue = {}) {
    for (const auto end = now + time; now < end; now += kTick * pace.stride()) {
      ++delays.count;
      delays.least = 10ms;
      delays.mean = delays.least + queue;
      pace.frame_due(is_ready, delays, now);
      if (level() != levels.back()) levels.push_back(level());
    }
  }
  Level level() const { return {pace.stride(), pace.coarseness(), pace.detail()}; }

  SteadyClock::time_point now{1h};
  AckDelays delays;
  FramePace pace;
  std::vector<Level> levels = {level()};  // one after the other
};

constexpr Level kBest = {1, 1, 3};
constexpr Level kWorst = {4, 4, 0};

TEST_F(FramePaceTest, WhoKeepsUpGetsAll) {
  run(60s, true, 40ms);
  EXPECT_EQ(level(), kBest);
}

TEST_F(FramePaceTest, RateThenPrecisionThenDetailAndBackInTheOppositeOrder) {
  run(20s, true, 200ms);
  const std::vector<Level> down = std::exchange(levels, {kWorst});
  EXPECT_EQ(down, (std::vector<Level>{{1, 1, 3},
                                      {2, 1, 3},
                                      {3, 1, 3},
                                      {4, 1, 3},
                                      {4, 2, 3},
                                      {4, 4, 3},
                                      {4, 4, 2},
                                      {4, 4, 1},
                                      {4, 4, 0}}));
  run(100s, true);
  EXPECT_EQ(levels, std::vector<Level>(down.rbegin(), down.rend()));
}

TEST_F(FramePaceTest, AFewMissedFramesChangeNothing) {
  for (int i = 0; i < 100; ++i) {
    run(1s, true);
    ++delays.count;
    pace.frame_due(false, delays, now += kTick);
  }
  EXPECT_EQ(level(), kBest);
}

TEST_F(FramePaceTest, WhoMissesMostFramesGoesDownFaster) {
  run(1s, false);
  EXPECT_GE(pace.stride(), 3U);
}

// Silence says nothing about the pace: there is a rule of its own for that.
TEST_F(FramePaceTest, NothingIsJudgedWithoutAnAcknowledgement) {
  delays.count = 5;
  pace.frame_due(true, delays, now);
  run(1s, true);
  for (int i = 0; i < 1000; ++i) pace.frame_due(false, delays, now += kTick);
  EXPECT_EQ(level(), kBest);
}

// A viewer for whom every second frame is right, and each frame is too much.
TEST_F(FramePaceTest, ARiseThatFailsIsTriedLessAndLessOften) {
  const auto count_rises = [&] {
    int rises = 0;
    for (const auto end = now + 120s; now < end; now += kTick) {
      const unsigned before = pace.stride();
      ++delays.count;
      delays.least = 10ms;
      delays.mean = pace.stride() == 1 ? Seconds(0.3) : Seconds(0.01);
      pace.frame_due(true, delays, now);
      if (pace.stride() < before) ++rises;
    }
    return rises;
  };
  const int first = count_rises();
  EXPECT_GT(first, 1);
  EXPECT_LE(first, 8) << "after 1, 2, 4, 8, 16, and then every 32 s";
  EXPECT_LE(count_rises(), 4);
  run(200s, true);
  EXPECT_EQ(level(), kBest) << "and stays where it holds";
}

TEST_F(FramePaceTest, TheDetailGoesDownNoFurtherThanHelps) {
  pace.set_least_detail(2);
  run(20s, false);
  EXPECT_EQ(level(), (Level{4, 4, 2}));
  run(2s, true);
  EXPECT_EQ(level(), (Level{4, 4, 3})) << "it has not gone further in secret";
  pace.set_least_detail(0);
  run(20s, false);
  EXPECT_EQ(level(), kWorst);
  pace.set_least_detail(3);
  EXPECT_EQ(level(), (Level{4, 4, 3}));
}

// Level d shows one in 2^(3 - d), of which there are to be 2000 at least.
TEST(LeastDetail, LeavesOutNothingOfAFewThousandParticles) {
  for (const std::size_t few : {0U, 1U, 2000U, 3999U}) EXPECT_EQ(least_detail(few), 3) << few;
  EXPECT_EQ(least_detail(4000), 2);
  EXPECT_EQ(least_detail(7999), 2);
  EXPECT_EQ(least_detail(8000), 1);
  EXPECT_EQ(least_detail(15999), 1);
  EXPECT_EQ(least_detail(16000), 0);
  EXPECT_EQ(least_detail(1000000), 0);
}

TEST_F(FramePaceTest, TheRateGoesDownNoFurtherThanIsAllowed) {
  pace = FramePace(1);
  run(20s, false);
  EXPECT_EQ(level(), (Level{1, 4, 0}));
}

}  // namespace
}  // namespace vat::frame_pace_test
