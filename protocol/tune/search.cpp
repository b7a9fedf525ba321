#include "protocol/tune/search.h"

#include <algorithm>
#include <numeric>

#include "core/support/check.h"

namespace vat::tune {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double total_seconds(const std::vector<Segment>& segments) {
  return std::accumulate(segments.begin(), segments.end(), 0.0,
                         [](double sum, const Segment& segment) { return sum + segment.seconds; });
}

double slowest_part(const Outcome& outcome) {
  return std::ranges::max(outcome.segments, {}, &Segment::seconds).seconds;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

class Search {
 public:
  Search(const SearchSettings& settings, const StartTrial& start)
      : settings_(settings),
        start_(start),
        outcomes_(settings.candidates),
        trials_(settings.candidates) {
    VAT_CHECK(settings.probe > 0 && settings.probe <= settings.moments);
  }

  std::vector<Outcome> run() {
    probe();
    complete();
    repeat();
    return std::move(outcomes_);
  }

 private:
  void probe() {
    for (std::size_t c = 0; c < outcomes_.size() && !settings_.stop(); ++c) {
      trials_[c] = start_(c);
      advance_to(c, settings_.probe);
      if (trials_[c]) trials_[c]->suspend();
    }
    for (std::size_t c = 0; c < outcomes_.size(); ++c) drop_if_dominated(c);
  }

  void complete() {
    std::vector<std::size_t> order(outcomes_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [this](std::size_t c) { return expected_seconds(c); });
    for (const std::size_t c : order) {
      drop_if_dominated(c);
      advance_to(c, settings_.moments);
      trials_[c].reset();
    }
  }

  double most_seconds() const {
    return settings_.drops == DropRule::never ? kNoLimit : settings_.most_seconds;
  }

  bool is_waiting(std::size_t c) const {
    return outcomes_[c].kind == OutcomeKind::waiting && trials_[c] != nullptr;
  }

  void advance_to(std::size_t c, std::size_t moment) {
    Outcome& outcome = outcomes_[c];
    while (is_waiting(c) && outcome.segments.size() < moment && !settings_.stop()) {
      const std::optional<Segment> segment =
          trials_[c]->advance(most_seconds() - outcome.seconds());
      if (settings_.stop()) return;
      if (segment) {
        outcome.segments.push_back(*segment);
        if (outcome.seconds() > most_seconds()) {
          end(c, OutcomeKind::dropped);
          return show();
        }
        if (outcome.segments.size() == settings_.moments) outcome.kind = OutcomeKind::completed;
        drop_if_dominated(c);
      } else {
        end(c, OutcomeKind::failed);
      }
      show();
    }
  }

  void end(std::size_t c, OutcomeKind kind) {
    outcomes_[c].kind = kind;
    trials_[c].reset();
  }

  void drop_if_dominated(std::size_t c) {
    if (!is_waiting(c) || outcomes_[c].segments.empty()) return;
    for (std::size_t d = 0; d < outcomes_.size(); ++d) {
      if (d == c || outcomes_[d].kind == OutcomeKind::failed || !dominates(d, c)) continue;
      outcomes_[c].dominated_by = d;
      return end(c, OutcomeKind::dropped);
    }
  }

  bool dominates(std::size_t d, std::size_t c) const {
    switch (settings_.drops) {
      case DropRule::expected:
        return is_better_so_far(d, c) || is_better_at_end(d, c);
      case DropRule::proven:
        return is_proven_better(d, c);
      case DropRule::never:
        return false;
    }
    return false;
  }

  Real error_at(std::size_t c, std::size_t moment) const {
    return std::max(outcomes_[c].segments[moment - 1].bound, settings_.floor);
  }

  double seconds_to(std::size_t c, std::size_t moment) const {
    double sum = 0;
    for (std::size_t k = 0; k < moment; ++k) sum += outcomes_[c].segments[k].seconds;
    return sum;
  }

  bool is_better_so_far(std::size_t d, std::size_t c) const {
    const std::size_t moment = outcomes_[c].segments.size();
    if (moment < kFirstComparison || outcomes_[d].segments.size() < moment) return false;
    return seconds_to(d, moment) * kTimeMargin <= seconds_to(c, moment) &&
           error_at(d, moment) * kErrorMargin <= error_at(c, moment);
  }

  bool is_better_at_end(std::size_t d, std::size_t c) const {
    if (!has_smaller_error_at_end(d, c)) return false;
    const double seconds = outcomes_[d].seconds();
    return seconds <= outcomes_[c].seconds() || seconds * kTimeMargin <= expected_seconds(c);
  }

  bool is_proven_better(std::size_t d, std::size_t c) const {
    return has_smaller_error_at_end(d, c) &&
           outcomes_[d].seconds() * kTimeMargin <= outcomes_[c].seconds() &&
           slowest_part(outcomes_[d]) * kTimeMargin <= slowest_part(outcomes_[c]);
  }

  /// Returns whether d is completed, with an error of at most the lower bound of that of c.
  bool has_smaller_error_at_end(std::size_t d, std::size_t c) const {
    return outcomes_[d].kind == OutcomeKind::completed &&
           error_at(d, settings_.moments) <= error_at(c, outcomes_[c].segments.size());
  }

  /// Returns the time of a whole run, from the time so far.
  double expected_seconds(std::size_t c) const {
    const std::vector<Segment>& segments = outcomes_[c].segments;
    if (segments.empty()) return 0;
    return total_seconds(segments) * static_cast<double>(settings_.moments) /
           static_cast<double>(segments.size());
  }

  /// Returns the candidates whose time decides: those near the front.
  std::vector<std::size_t> near_front() const {
    const std::vector<Point> points = points_of(outcomes_, settings_);
    const std::vector<Point> front = pareto_front(points);
    std::vector<std::size_t> near;
    for (const Point& point : points) {
      const auto beats = [&point](const Point& other) {
        return other.error <= point.error && other.seconds * kTimeMargin < point.seconds;
      };
      if (std::ranges::none_of(front, beats)) near.push_back(point.candidate);
    }
    return near;
  }

  void repeat() {
    const std::vector<std::size_t> chosen = near_front();
    std::vector<std::vector<std::vector<double>>> times(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      for (const Segment& segment : outcomes_[chosen[i]].segments) {
        times[i].push_back({segment.seconds});
      }
    }
    for (const std::size_t c : chosen) repeated_seconds_ += outcomes_[c].seconds();
    to_repeat_ = chosen.size() * static_cast<std::size_t>(std::max(0, settings_.repetitions - 1));
    for (int n = 1; n < settings_.repetitions; ++n) {
      for (std::size_t i = 0; i < chosen.size(); ++i) time_again(chosen[i], times[i]);
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      for (std::size_t k = 0; k < settings_.moments; ++k) {
        outcomes_[chosen[i]].segments[k].seconds = median_of(times[i][k]);
      }
    }
  }

  void time_again(std::size_t c, std::vector<std::vector<double>>& times) {
    const std::unique_ptr<Trial> trial = settings_.stop() ? nullptr : start_(c);
    for (std::size_t k = 0; k < settings_.moments && !settings_.stop(); ++k) {
      const std::optional<Segment> segment = trial->advance(kNoLimit);
      if (settings_.stop() || !segment) return;
      times[k].push_back(segment->seconds);
    }
    ++repeated_;
    show();
  }

  /// Returns the mean expected time of the runs that have started.
  double mean_seconds() const {
    double sum = 0;
    int started = 0;
    for (std::size_t c = 0; c < outcomes_.size(); ++c) {
      if (outcomes_[c].segments.empty()) continue;
      sum += expected_seconds(c);
      ++started;
    }
    return started > 0 ? sum / started : 0;
  }

  void show() const {
    Progress progress{.completed = repeated_, .runs = outcomes_.size() + to_repeat_};
    const double mean = mean_seconds();
    for (std::size_t c = 0; c < outcomes_.size(); ++c) {
      const Outcome& outcome = outcomes_[c];
      if (outcome.kind != OutcomeKind::waiting) {
        ++progress.completed;
      } else {
        progress.remaining +=
            outcome.segments.empty() ? mean : expected_seconds(c) - outcome.seconds();
      }
    }
    if (to_repeat_ > 0) {
      const std::size_t left = to_repeat_ - repeated_;
      progress.remaining += repeated_seconds_ * static_cast<double>(left) *
                            (settings_.repetitions - 1) / static_cast<double>(to_repeat_);
    }
    settings_.show(progress);
  }

  const SearchSettings& settings_;
  const StartTrial& start_;
  std::vector<Outcome> outcomes_;
  std::vector<std::unique_ptr<Trial>> trials_;
  std::size_t to_repeat_ = 0;
  std::size_t repeated_ = 0;
  double repeated_seconds_ = 0;  ///< time of one repetition of all repeated candidates
};

}  // namespace

double Outcome::seconds() const {
  return total_seconds(segments);
}

std::vector<Outcome> search(const SearchSettings& settings, const StartTrial& start) {
  return Search(settings, start).run();
}

std::vector<Point> points_of(const std::vector<Outcome>& outcomes, const SearchSettings& settings) {
  const double parts = static_cast<double>(settings.moments);
  std::vector<Point> points;
  for (std::size_t c = 0; c < outcomes.size(); ++c) {
    const Outcome& outcome = outcomes[c];
    if (outcome.kind != OutcomeKind::completed) continue;
    points.push_back({c, outcome.seconds() / settings.duration,
                      slowest_part(outcome) * parts / settings.duration,
                      std::max(outcome.segments.back().bound, settings.floor)});
  }
  return points;
}

}  // namespace vat::tune
