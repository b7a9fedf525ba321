#include "tests/bench/accuracy/law_report.h"

#include <algorithm>
#include <array>
#include <limits>

#include "tests/bench/accuracy/control_report.h"

namespace vat::bench {

namespace {

struct Variation {
  const char* ending;
  const char* first_law;
  const char* second_law;
};

constexpr std::array kVariations = {Variation{"-implicit", "explicit springs", "implicit springs"},
                                    Variation{"-projection", "penalties", "projection"}};

void add_rows(const std::string& problem, const std::string& law, const ProblemResult& result,
              Table& table) {
  for (const Real target : kTargetErrors) {
    const auto best = cheapest(result.solutions, target, seconds_of);
    table.rows.push_back(
        {problem, law, target, best ? name_of(best->method) : std::string("none reaches it"),
         best ? best->step : kAbsent, best ? best->evaluations_per_particle : kAbsent,
         best ? best->seconds : kAbsent});
  }
}

Series front_of(const ProblemResult& result, const std::string& law, std::size_t colour) {
  Series series{.label = law, .points = {}, .colour = colour};
  for (const Solution& solution : pareto_front(result.solutions, seconds_of)) {
    if (solution.error <= 1) series.points.push_back({solution.seconds, solution.error});
  }
  return series;
}

}  // namespace

std::vector<LawPair> pairs_of_laws(const std::vector<ProblemResult>& results) {
  std::vector<LawPair> pairs;
  for (const ProblemResult& first : results) {
    for (const Variation& variation : kVariations) {
      const auto second =
          std::ranges::find(results, first.name + variation.ending, &ProblemResult::name);
      if (second == results.end()) continue;
      pairs.push_back({&first, &*second, variation.first_law, variation.second_law});
    }
  }
  return pairs;
}

Table laws_table(const std::vector<LawPair>& pairs) {
  Table table{{"problem", "law", "error at most", "least time", "step [s]",
               "evaluations per particle", "seconds"},
              {}};
  for (const LawPair& pair : pairs) {
    add_rows(pair.first->name, pair.first_law, *pair.first, table);
    add_rows(pair.first->name, pair.second_law, *pair.second, table);
  }
  return table;
}

LogPlot laws_plot(const LawPair& pair) {
  return {.title = pair.first->name + ": " + pair.first->title,
          .x_label = "wall time [s], median of the runs",
          .y_label = "relative error of the " + pair.first->error_name,
          .series = {front_of(*pair.first, pair.first_law, 0),
                     front_of(*pair.second, pair.second_law, 1)}};
}

Status write_laws(const std::vector<LawPair>& pairs, const std::filesystem::path& folder) {
  if (pairs.empty()) return {};
  Status done = write_table(laws_table(pairs), folder, "laws", "# Run time against error: laws");
  for (const LawPair& pair : pairs) {
    if (done) done = write_plot(laws_plot(pair), folder, pair.first->name + "-laws");
  }
  return done;
}

}  // namespace vat::bench
