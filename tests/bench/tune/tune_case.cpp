#include "tests/bench/tune/tune_case.h"

#include <algorithm>

namespace vat::bench {

namespace {

const tune::Point* find_point(const std::vector<tune::Point>& points, std::size_t candidate) {
  const auto found = std::ranges::find(points, candidate, &tune::Point::candidate);
  return found == points.end() ? nullptr : &*found;
}

/// Returns the greatest ratio of times over the errors of the exhaustive front.
double worst_time_ratio(const std::vector<tune::Point>& searched,
                        const std::vector<tune::Point>& all, Real floor) {
  double worst = 1;
  for (const tune::Point& best : tune::pareto_front(all)) {
    const Result<tune::Point> choice = tune::choose_for_error(searched, best.error, floor);
    if (!choice) return kAbsent;
    const tune::Point* chosen = find_point(all, choice.value().candidate);
    if (chosen == nullptr) return kAbsent;
    worst = std::max(worst, chosen->seconds / best.seconds);
  }
  return worst;
}

double real_time_ratio(const std::vector<tune::Point>& searched,
                       const std::vector<tune::Point>& all) {
  const Result<tune::Point> best = tune::choose_for_real_time(all);
  const Result<tune::Point> choice = tune::choose_for_real_time(searched);
  if (!best || !choice) return kAbsent;
  const tune::Point* chosen = find_point(all, choice.value().candidate);
  return chosen == nullptr ? kAbsent : chosen->error / best.value().error;
}

}  // namespace

TuneResultRow compare_searches(const std::string& name, const tune::Tuning& tuning,
                               const std::vector<tune::Outcome>& searched,
                               const std::vector<tune::Outcome>& all) {
  const std::vector<tune::Point> found = tuning.points(searched);
  const std::vector<tune::Point> points = tuning.points(all);
  TuneResultRow row{.scene = name, .candidates = searched.size()};
  row.dropped = static_cast<std::size_t>(
      std::ranges::count(searched, tune::OutcomeKind::dropped, &tune::Outcome::kind));
  row.front = tune::pareto_front(points).size();
  row.noise = tuning.measure().floor();
  if (const tune::Point* own = find_point(points, tuning.set().own)) {
    row.own_error = own->error;
    row.own_seconds = own->seconds;
  }
  row.worst_time = worst_time_ratio(found, points, row.noise);
  row.real_time_error = real_time_ratio(found, points);
  return row;
}

Table tune_table(const std::vector<TuneResultRow>& rows) {
  Table table{{"scene", "candidates", "dropped", "front", "noise", "own error", "own s per s",
               "greatest time / best", "real time: error / best", "search [s]", "exhaustive [s]"},
              {}};
  for (const TuneResultRow& row : rows) {
    table.rows.push_back({row.scene, std::uint64_t{row.candidates}, std::uint64_t{row.dropped},
                          std::uint64_t{row.front}, row.noise, row.own_error, row.own_seconds,
                          row.worst_time, row.real_time_error, row.search_seconds,
                          row.exhaustive_seconds});
  }
  return table;
}

}  // namespace vat::bench
