#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/tune/front.h"

namespace vat::front_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tune::Point;

std::vector<std::size_t> indices(const std::vector<Point>& points) {
  std::vector<std::size_t> found;
  for (const Point& point : points) found.push_back(point.candidate);
  return found;
}

// The slowest part takes twice the mean, except that of candidate 4.
const std::vector<Point> kPoints{
    {0, 0.10, 0.20, 0.1},  {1, 0.20, 0.40, 0.2},  {2, 0.20, 0.40, 0.01}, {3, 0.40, 0.80, 1e-3},
    {4, 0.30, 0.90, 5e-3}, {5, 0.50, 1.00, 1e-4}, {6, 0.50, 0.79, 1e-4}, {7, 0.60, 1.20, 1e-3}};

TEST(Front, ContainsThePointsThatNoOtherDominates) {
  EXPECT_THAT(indices(tune::pareto_front(kPoints)), ElementsAre(0, 2, 4, 3, 5));
  EXPECT_THAT(tune::pareto_front({}), IsEmpty());
}

TEST(Front, FastestPointWithTheErrorIsChosen) {
  EXPECT_EQ(tune::choose_for_error(kPoints, 0.1, 1e-5).value().candidate, 0u);
  EXPECT_EQ(tune::choose_for_error(kPoints, 0.09, 1e-5).value().candidate, 2u);
  EXPECT_EQ(tune::choose_for_error(kPoints, 1e-3, 1e-5).value().candidate, 3u);
}

TEST(Front, UnreachedErrorsNameTheLeastErrorAndTheNoise) {
  const auto below = tune::choose_for_error(kPoints, 1e-5, 1e-6);
  ASSERT_FALSE(below);
  EXPECT_EQ(below.errors().front().code, "not_reached");
  EXPECT_THAT(below.errors().front().message,
              HasSubstr("at most 1e-05; the least error is 0.0001"));
  EXPECT_THAT(below.errors().front().message, Not(HasSubstr("noise")));
  const auto noisy = tune::choose_for_error(kPoints, 1e-5, 1e-4);
  ASSERT_FALSE(noisy);
  EXPECT_THAT(noisy.errors().front().message, HasSubstr("below the noise of the scene, 0.0001"));
  EXPECT_FALSE(tune::choose_for_error({}, 1, 0));
}

TEST(Front, RealTimeLeavesAFifthOfEveryPartFree) {
  // Candidate 6 has the error of candidate 5, whose slowest part takes all of the time.
  EXPECT_EQ(tune::choose_for_real_time(kPoints).value().candidate, 6u);
  const std::vector<Point> limit{{0, 0.1, 0.3, 0.1}, {1, 0.4, 0.8, 0.01}, {2, 0.4, 0.801, 0.001}};
  EXPECT_EQ(tune::choose_for_real_time(limit).value().candidate, 1u);
  const std::vector<Point> equal{{0, 0.3, 0.3, 0.1}, {1, 0.2, 0.4, 0.1}};
  EXPECT_EQ(tune::choose_for_real_time(equal).value().candidate, 1u);
}

TEST(Front, TooSlowScenesNameTheFastestPoint) {
  const std::vector<Point> slow{{0, 1, 2, 0.1}, {1, 1.2, 1.5, 0.01}};
  const auto choice = tune::choose_for_real_time(slow);
  ASSERT_FALSE(choice);
  EXPECT_THAT(choice.errors().front().message, HasSubstr("the fastest one needs 1.5 s"));
  EXPECT_FALSE(tune::choose_for_real_time({}));
}

TEST(Front, CheaperPointsBeginWithTheChoice) {
  const auto cheaper = [](std::size_t choice, std::size_t most) {
    return indices(tune::cheaper_points(kPoints, kPoints[choice], most));
  };
  EXPECT_THAT(cheaper(3, 4), ElementsAre(3, 4, 2, 0));
  // Candidate 7 is not in the front. Candidates 3 and 6 have no greater error.
  EXPECT_THAT(cheaper(7, 9), ElementsAre(7, 4, 2, 0));
  EXPECT_THAT(cheaper(0, 9), ElementsAre(0));
  EXPECT_THAT(cheaper(5, 3), ElementsAre(5, 4, 0));
  EXPECT_THAT(cheaper(5, 2), ElementsAre(5, 0));
}

}  // namespace
}  // namespace vat::front_test
