// The rules by which the governor chooses among the points of a front.

#include "server/session/ticks/governor.h"

#include <gtest/gtest.h>

namespace vat::governor_test {
namespace {

using Choice = std::optional<std::size_t>;

const std::vector<GovernorPoint> kPoints{
    {{.step = 1e-3}, 1e-4, 0.8}, {{.step = 2e-3}, 1e-3, 0.4}, {{.step = 4e-3}, 1e-2, 0.2}};
constexpr double kInterval = 0.5;

/// A session that follows the governor.
class GovernorTest : public testing::Test {
 protected:
  /// Returns the seconds until the governor changes the point, or nothing after `most` seconds.
  std::optional<double> run(bool is_behind, double load, double most = 10'000) {
    for (double time = kInterval; time <= most; time += kInterval) {
      const Choice choice = governor.add({kInterval, is_behind, load}, point, kPoints);
      if (!choice) continue;
      point = *choice;
      return time;
    }
    return {};
  }
  std::optional<double> fall_behind(double most = 10'000) { return run(true, 1.2, most); }

  Governor governor;
  std::size_t point = 0;
};

TEST_F(GovernorTest, UsesTheNextCheaperPointAfterSecondsOfDelay) {
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 1u);
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 2u);
  EXPECT_FALSE(fall_behind()) << "there is no cheaper point";
}

TEST_F(GovernorTest, ShortDelaysChangeNothing) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(fall_behind(Governor::kBehindSeconds - kInterval));
    EXPECT_FALSE(run(false, 0.9, kInterval));
  }
}

TEST_F(GovernorTest, DelaysBeforeAPauseDoNotCount) {
  EXPECT_FALSE(fall_behind(Governor::kBehindSeconds - kInterval));
  governor.restart();
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
}

TEST_F(GovernorTest, ReturnsIfThePredictedLoadLeavesAFifthFree) {
  point = 2;
  EXPECT_FALSE(run(false, 0.41)) << "the more accurate point takes twice the time";
  EXPECT_EQ(run(false, 0.39), Governor::kReserveSeconds);
  EXPECT_EQ(point, 1u);
  EXPECT_EQ(run(false, 0.39), Governor::kReserveSeconds);
  EXPECT_EQ(point, 0u);
  EXPECT_FALSE(run(false, 0.1)) << "there is no more accurate point";
}

TEST_F(GovernorTest, AGreaterLoadRestartsTheTimeOfTheReserve) {
  point = 1;
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(run(false, 0.1, Governor::kReserveSeconds - kInterval));
    EXPECT_FALSE(run(false, 0.5, kInterval));
  }
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
}

TEST_F(GovernorTest, FailedPointsWaitTwiceAsLongAfterEachFailure) {
  fall_behind();
  ASSERT_EQ(point, 1u);
  ASSERT_EQ(run(false, 0.1), Governor::kReserveSeconds);
  double wait = Governor::kLeastWait;
  for (int failure = 0; failure < 12; ++failure) {
    ASSERT_EQ(point, 0u);
    ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
    EXPECT_EQ(run(false, 0.1), std::max(wait, Governor::kReserveSeconds)) << failure;
    wait = std::min(2 * wait, Governor::kMostWait);
  }
}

TEST_F(GovernorTest, APointThatPassesItsTrialHasNoFailures) {
  fall_behind();
  run(false, 0.1);
  fall_behind();  // point 0 fails
  ASSERT_EQ(run(false, 0.1), Governor::kLeastWait);
  ASSERT_FALSE(run(false, 0.1, Governor::kTrialSeconds));
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds) << "no failure, since the trial has ended";
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
  fall_behind();
  EXPECT_EQ(run(false, 0.1), Governor::kLeastWait) << "the first failure again";
}

TEST_F(GovernorTest, AChangeByAParticipantStartsNoTrial) {
  point = 1;
  ASSERT_FALSE(run(false, 0.5, 20));
  point = 0;
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
}

TEST_F(GovernorTest, SkipsAPointThatTheSessionCannotUse) {
  governor.fail(1);
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 2u);
}

TEST_F(GovernorTest, TriesAPointAgainAfterARefusal) {
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  ASSERT_EQ(point, 2u);
  point = 1;
  governor.fail(2);  // the command was refused
  EXPECT_EQ(fall_behind(), Governor::kLeastWait);
  EXPECT_EQ(point, 2u);
}

}  // namespace
}  // namespace vat::governor_test
