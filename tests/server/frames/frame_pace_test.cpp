#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "server/clients/frame_window.h"
#include "server/frames/frame_groups.h"
#include "server/frames/frame_pace.h"

namespace vat::test::frame_pace_test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

using Seconds = std::chrono::duration<double>;

using Level = std::array<unsigned, 3>;  // stride, coarseness, detail

class FramePaceTest : public testing::Test {
 protected:
  static constexpr auto kTick = 20ms;

  /// Simulates frames for a given time. Each finds the viewer ready or not. Acknowledgements arrive
  /// `queue` later than possible.
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
  std::vector<Level> levels = {level()};  // sequence of levels
};

constexpr Level kBest = {1, 1, 3};
constexpr Level kWorst = {4, 4, 0};

TEST_F(FramePaceTest, AFastViewerReceivesAllFrames) {
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

TEST_F(FramePaceTest, ManyMissedFramesReduceTheRateFaster) {
  run(1s, false);
  EXPECT_GE(pace.stride(), 3U);
}

// Missing acknowledgements do not change the pace. Another rule handles them.
TEST_F(FramePaceTest, NothingIsJudgedWithoutAnAcknowledgement) {
  delays.count = 5;
  pace.frame_due(true, delays, now);
  run(1s, true);
  for (int i = 0; i < 1000; ++i) pace.frame_due(false, delays, now += kTick);
  EXPECT_EQ(level(), kBest);
}

// A viewer that can receive every second frame, but not every frame.
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
  EXPECT_LE(first, 8) << "rises after 1, 2, 4, 8 and 16 s, then every 32 s";
  EXPECT_LE(count_rises(), 4);
  run(200s, true);
  EXPECT_EQ(level(), kBest) << "the best level is kept";
}

TEST_F(FramePaceTest, TheDetailGoesDownNoFurtherThanHelps) {
  pace.set_least_detail(2);
  run(20s, false);
  EXPECT_EQ(level(), (Level{4, 4, 2}));
  run(2s, true);
  EXPECT_EQ(level(), (Level{4, 4, 3})) << "the level is limited internally too";
  pace.set_least_detail(0);
  run(20s, false);
  EXPECT_EQ(level(), kWorst);
  pace.set_least_detail(3);
  EXPECT_EQ(level(), (Level{4, 4, 3}));
}

// Level d shows one of 2^(3 - d) particles, and at least 2000 of them.
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

TEST(FrameGroups, AllIfThereAreFew) {
  EXPECT_THAT(choose_groups({}, 8), ElementsAre());
  const std::vector<GroupClaim> claims = {{1, 0}, {5, 0}, {3, 9}};
  EXPECT_THAT(choose_groups(claims, 3), ElementsAre(1, 2, 0)) << "largest first";
}

TEST(FrameGroups, HalfForTheLargestAndHalfForTheLongestWait) {
  const std::vector<GroupClaim> claims = {{100, 0}, {1, 7}, {50, 0}, {2, 1}, {40, 0}, {1, 8}};
  EXPECT_THAT(choose_groups(claims, 4), UnorderedElementsAre(0, 2, 5, 1));
}

TEST(FrameGroups, TheLargerOfGroupsWithEqualWaits) {
  const std::vector<GroupClaim> claims = {{9, 0}, {1, 2}, {3, 2}, {2, 2}};
  EXPECT_THAT(choose_groups(claims, 2), UnorderedElementsAre(0, 2));
}

}  // namespace
}  // namespace vat::test::frame_pace_test
