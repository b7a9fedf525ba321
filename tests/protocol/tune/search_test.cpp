// The search with trials whose times and errors are given.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "protocol/tune/search.h"

namespace vat::search_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Pointwise;
using tune::Outcome;
using tune::OutcomeKind;
using tune::Point;
using tune::Progress;
using tune::SearchSettings;
using tune::Segment;

constexpr std::size_t kMoments = 10;

/// A candidate whose error grows quadratically with time.
struct Given {
  double seconds = 1;                   ///< of a run
  Real error = 1;                       ///< at the end
  std::size_t fails_at = kMoments + 1;  ///< moment
  std::vector<double> factors{1};       ///< of the time, by run; the last one is repeated
  double first = 1;                     ///< factor of the time of the first part
};

class Machine {
 public:
  explicit Machine(std::vector<Given> given) : given_(std::move(given)), starts_(given_.size()) {}

  std::vector<Outcome> search(SearchSettings settings) {
    settings.candidates = given_.size();
    settings.moments = kMoments;
    return tune::search(settings, [this](std::size_t c) { return start(c); });
  }

  std::size_t advances() const { return advances_; }
  const std::vector<std::size_t>& order() const { return order_; }  ///< of the starts

 private:
  class GivenTrial final : public tune::Trial {
   public:
    GivenTrial(const Given& given, double factor, std::size_t& advances)
        : given_(given), factor_(factor), advances_(advances) {}
    std::optional<Segment> advance(double most_seconds) override {
      ++advances_;
      if (++moment_ == given_.fails_at) return {};
      const Real share = static_cast<Real>(moment_) / kMoments;
      const double factor = moment_ == 1 ? factor_ * given_.first : factor_;
      const double seconds = factor * given_.seconds / kMoments;
      // A run that is stopped exceeds the limit by a little.
      return Segment{std::min(seconds, 1.001 * most_seconds), given_.error * share * share, 1, 2};
    }

   private:
    const Given& given_;
    double factor_;
    std::size_t& advances_;
    std::size_t moment_ = 0;
  };

  std::unique_ptr<tune::Trial> start(std::size_t c) {
    const Given& given = given_[c];
    const std::size_t run = std::min(starts_[c]++, given.factors.size() - 1);
    order_.push_back(c);
    return std::make_unique<GivenTrial>(given, given.factors[run], advances_);
  }

  std::vector<Given> given_;
  std::vector<std::size_t> starts_;
  std::vector<std::size_t> order_;
  std::size_t advances_ = 0;
};

MATCHER(SameCandidate, "") {
  return std::get<0>(arg).candidate == std::get<1>(arg).candidate;
}

SearchSettings once() {
  SearchSettings settings;
  settings.repetitions = 1;
  return settings;
}

std::vector<OutcomeKind> kinds(const std::vector<Outcome>& outcomes) {
  std::vector<OutcomeKind> found;
  for (const Outcome& outcome : outcomes) found.push_back(outcome.kind);
  return found;
}

TEST(Search, DominatedCandidatesEndEarly) {
  Machine machine({{1, 0.01}, {1.3, 0.09}, {2, 0.005}});
  const auto outcomes = machine.search(once());
  EXPECT_THAT(kinds(outcomes),
              ElementsAre(OutcomeKind::completed, OutcomeKind::dropped, OutcomeKind::completed));
  EXPECT_EQ(outcomes[1].segments.size(), tune::kFirstComparison);
  EXPECT_EQ(outcomes[1].dominated_by, 0u);
  EXPECT_EQ(machine.advances(), 2 * kMoments + tune::kFirstComparison);
}

TEST(Search, ASlowFirstPartDropsNothing) {
  Machine machine({{.seconds = 0.6, .error = 0.01}, {.seconds = 0.3, .error = 0.25, .first = 3}});
  EXPECT_THAT(kinds(machine.search(once())), Each(OutcomeKind::completed));
}

TEST(Search, BetterCandidatesDropEarlierOnes) {
  Machine machine({{2, 0.09}, {1, 0.01}});
  const auto outcomes = machine.search(once());
  EXPECT_THAT(kinds(outcomes), ElementsAre(OutcomeKind::dropped, OutcomeKind::completed));
  EXPECT_EQ(outcomes[0].segments.size(), once().probe);
}

TEST(Search, SmallDifferencesDropNothingBeforeTheEnd) {
  Machine machine({{1, 0.01}, {1.2, 0.09}, {1.5, 0.07}});
  const auto outcomes = machine.search(once());
  // The third candidate is dropped when its expected time and its bound exceed those of the first.
  EXPECT_EQ(outcomes[1].segments.size() > once().probe, true);
  EXPECT_EQ(outcomes[0].kind, OutcomeKind::completed);
  EXPECT_EQ(outcomes[2].segments.size() > once().probe, true);
}

TEST(Search, ErrorsBelowTheNoiseAreEqual) {
  SearchSettings settings = once();
  settings.floor = 0.02;
  Machine machine({{2, 1e-4}, {1, 0.01}, {3, 1e-6}});
  const auto outcomes = machine.search(settings);
  EXPECT_THAT(kinds(outcomes),
              ElementsAre(OutcomeKind::dropped, OutcomeKind::completed, OutcomeKind::dropped));
  // The noise does not decide before a run is complete.
  EXPECT_EQ(outcomes[2].segments.size(), settings.probe);
  settings.candidates = 3;
  settings.moments = kMoments;
  const std::vector<Point> points = tune::points_of(outcomes, settings);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].error, 0.02);
}

TEST(Search, FailedCandidatesDominateNothing) {
  Machine machine({{.seconds = 0.1, .error = 1e-6, .fails_at = 2}, {1, 0.01}});
  EXPECT_THAT(kinds(machine.search(once())),
              ElementsAre(OutcomeKind::failed, OutcomeKind::completed));
}

TEST(Search, ExhaustiveSearchCompletesAll) {
  SearchSettings settings = once();
  settings.drops = tune::DropRule::never;
  Machine machine({{1, 0.01}, {2, 0.1}, {4, 1}});
  EXPECT_THAT(kinds(machine.search(settings)), Each(OutcomeKind::completed));
  EXPECT_EQ(machine.advances(), 3 * kMoments);
}

TEST(Search, ProvenRuleDropsOnlyWorseRuns) {
  SearchSettings settings = once();
  settings.drops = tune::DropRule::proven;
  // The time of the second candidate exceeds 1.25 s after 7 of 10 parts. The third one is too
  // similar to the first one, and the fourth one is more accurate.
  Machine machine({{1, 0.01}, {2, 0.1}, {1.2, 0.1}, {5, 0.001}});
  const auto outcomes = machine.search(settings);
  EXPECT_THAT(kinds(outcomes), ElementsAre(OutcomeKind::completed, OutcomeKind::dropped,
                                           OutcomeKind::completed, OutcomeKind::completed));
  EXPECT_EQ(outcomes[1].segments.size(), 7u);
}

TEST(Search, SlowRunsEndEarly) {
  for (const auto& [rule, kind, seconds] :
       {std::tuple{tune::DropRule::expected, OutcomeKind::dropped, 3.0},
        {tune::DropRule::proven, OutcomeKind::dropped, 3.0},
        {tune::DropRule::never, OutcomeKind::completed, 200.0}}) {
    SearchSettings settings = once();
    settings.drops = rule;
    settings.most_seconds = 3;
    Machine machine({{1, 0.01}, {200, 0.001}, {2.9, 0.005}});
    const auto outcomes = machine.search(settings);
    EXPECT_THAT(kinds(outcomes), ElementsAre(OutcomeKind::completed, kind, OutcomeKind::completed));
    EXPECT_NEAR(outcomes[1].seconds(), seconds, 0.01);
    EXPECT_EQ(outcomes[1].dominated_by, std::nullopt);
  }
}

TEST(Search, ProvenRuleKeepsRunsWhoseSlowestPartIsFaster) {
  SearchSettings settings = once();
  settings.drops = tune::DropRule::proven;
  Machine machine({{.seconds = 1, .error = 0.01, .first = 5}, {4, 0.1}, {7, 0.1}});
  EXPECT_THAT(kinds(machine.search(settings)),
              ElementsAre(OutcomeKind::completed, OutcomeKind::completed, OutcomeKind::dropped));
}

TEST(Search, TimesAreMediansOfAlternateRuns) {
  SearchSettings settings;
  settings.repetitions = 3;
  Machine machine({{.seconds = 1, .error = 0.1, .factors = {5, 1, 1.1}},
                   {.seconds = 8, .error = 0.01, .factors = {1, 1.2, 0.1}}});
  const auto outcomes = machine.search(settings);
  EXPECT_NEAR(outcomes[0].seconds(), 1.1, 1e-12);
  EXPECT_NEAR(outcomes[1].seconds(), 8, 1e-12);
  EXPECT_THAT(machine.order(), ElementsAre(0, 1, 0, 1, 0, 1));
}

TEST(Search, StopKeepsTheCompletedCandidates) {
  Machine machine({{1, 0.1}, {2, 0.01}});
  SearchSettings settings = once();
  const std::size_t last = 2 * settings.probe + (kMoments - settings.probe) + 1;
  settings.stop = [&machine, last] { return machine.advances() >= last; };
  const auto outcomes = machine.search(settings);
  EXPECT_THAT(kinds(outcomes), ElementsAre(OutcomeKind::completed, OutcomeKind::waiting));
  EXPECT_EQ(machine.advances(), last);
}

TEST(Search, RemainingTimeEndsAtZero) {
  std::vector<Progress> shown;
  SearchSettings settings;
  settings.show = [&shown](const Progress& progress) { shown.push_back(progress); };
  Machine machine({{1, 0.1}, {2, 0.01}, {4, 0.001}});
  static_cast<void>(machine.search(settings));
  ASSERT_FALSE(shown.empty());
  // After the first part, all runs are expected to take as long as the first one.
  EXPECT_NEAR(shown.front().remaining, 2.9, 1e-12);
  EXPECT_NEAR(shown.back().remaining, 0, 1e-12);
  EXPECT_EQ(shown.back().completed, shown.back().runs);
  EXPECT_EQ(shown.back().runs, 9u);
}

/// Candidates like those of scenes: errors decrease with time, with random factors.
std::vector<Given> random_candidates(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Given> given;
  for (int c = 0; c < 40; ++c) {
    const double seconds = std::exp2(4 * share(random));
    given.push_back({seconds, 0.3 * std::pow(seconds, -2) * std::exp2(5 * share(random))});
  }
  return given;
}

TEST(Search, ProvenRuleKeepsTheFrontInLessTime) {
  std::mt19937 random(7);
  for (int n = 0; n < 20; ++n) {
    Machine all(random_candidates(random));
    Machine some = all;
    SearchSettings settings = once();
    settings.moments = kMoments;
    settings.drops = tune::DropRule::never;
    const auto front = pareto_front(tune::points_of(all.search(settings), settings));
    settings.drops = tune::DropRule::proven;
    const auto kept = pareto_front(tune::points_of(some.search(settings), settings));
    EXPECT_THAT(kept, Pointwise(SameCandidate(), front)) << n;
    EXPECT_LT(some.advances(), all.advances());
  }
}

TEST(Search, ChoicesAreThoseOfTheExhaustiveSearchInLessTime) {
  std::mt19937 random(7);
  std::size_t advances = 0;
  constexpr std::size_t kCases = 50;
  for (std::size_t n = 0; n < kCases; ++n) {
    Machine machine(random_candidates(random));
    SearchSettings settings = once();
    const auto searched = machine.search(settings);
    advances += machine.advances();
    settings.drops = tune::DropRule::never;
    const auto all = machine.search(settings);
    settings.moments = kMoments;
    for (const Real error : {0.3, 0.1, 0.03, 0.01, 0.003}) {
      const auto choice = choose_for_error(tune::points_of(searched, settings), error, 1e-9);
      const auto best = choose_for_error(tune::points_of(all, settings), error, 1e-9);
      ASSERT_EQ(choice.ok(), best.ok());
      if (!best) continue;
      EXPECT_LE(choice.value().seconds, tune::kTimeMargin * best.value().seconds) << n << error;
    }
  }
  EXPECT_LT(advances, kCases * 40 * kMoments * 8 / 10);
}

}  // namespace
}  // namespace vat::search_test
