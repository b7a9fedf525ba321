#include "tests/bench/accuracy/accuracy_report.h"

#include <algorithm>
#include <array>
#include <limits>

#include "tests/bench/accuracy/control_report.h"

namespace vat::bench {

namespace {

/// Errors above the size of the problem mean that the method failed.
std::vector<std::array<Real, 2>> points_of(const std::vector<Solution>& solutions,
                                           double (*cost)(const Solution&)) {
  std::vector<std::array<Real, 2>> points;
  for (const Solution& solution : solutions) {
    if (solution.error <= 1) points.push_back({cost(solution), solution.error});
  }
  return points;
}

LogPlot error_plot(const ProblemResult& result, const std::string& x_label,
                   double (*cost)(const Solution&)) {
  LogPlot plot{.title = result.name + ": " + result.title,
               .x_label = x_label,
               .y_label = "relative error of the " + result.error_name,
               .series = {}};
  plot.series.push_back({.label = "Pareto front",
                         .points = points_of(pareto_front(result.solutions, cost), cost),
                         .broad = true});
  for (const Method& method : all_methods()) {
    std::vector<Solution> own;
    std::ranges::copy_if(result.solutions, std::back_inserter(own), [&](const Solution& solution) {
      return name_of(solution.method) == name_of(method);
    });
    const std::vector<std::array<Real, 2>> points = points_of(own, cost);
    if (points.empty()) continue;
    plot.series.push_back({.label = name_of(method),
                           .points = points,
                           .colour = static_cast<std::size_t>(method.integrator),
                           .dash = static_cast<std::size_t>(method.control)});
  }
  return plot;
}

std::vector<Cell> cells_of(const std::optional<Solution>& solution, Real cost) {
  if (!solution) return {std::string("none reaches it"), kAbsent, kAbsent, kAbsent};
  return {name_of(solution->method), solution->step,
          solution->tolerance > 0 ? solution->tolerance : kAbsent, cost};
}

}  // namespace

Table solutions_table(const std::vector<ProblemResult>& results) {
  Table table{{"case", "integrator", "control", "step", "tolerance", "error", "seconds", "steps",
               "force evaluations", "evaluations per particle", "state hash", "failure"},
              {}};
  for (const ProblemResult& result : results) {
    for (const Solution& solution : result.solutions) {
      table.rows.push_back({result.name, std::string(to_string(solution.method.integrator)),
                            std::string(to_string(solution.method.control)), solution.step,
                            solution.tolerance > 0 ? solution.tolerance : kAbsent, solution.error,
                            solution.failure.empty() ? solution.seconds : kAbsent, solution.steps,
                            solution.force_evaluations, solution.evaluations_per_particle,
                            hash_text(solution.state_hash), solution.failure});
    }
  }
  return table;
}

Table cheapest_table(const std::vector<ProblemResult>& results) {
  Table table{
      {"case", "error at most", "fewest evaluations", "step [s]", "tolerance",
       "evaluations per particle", "least time", "its step [s]", "its tolerance", "seconds"},
      {}};
  for (const ProblemResult& result : results) {
    for (const Real target : kTargetErrors) {
      const auto by_count = cheapest(result.solutions, target, evaluations_of);
      const auto by_time = cheapest(result.solutions, target, seconds_of);
      std::vector<Cell> row = {result.name, target};
      std::ranges::move(cells_of(by_count, by_count ? by_count->evaluations_per_particle : kAbsent),
                        std::back_inserter(row));
      std::ranges::move(cells_of(by_time, by_time ? by_time->seconds : kAbsent),
                        std::back_inserter(row));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

LogPlot error_against_seconds(const ProblemResult& result) {
  return error_plot(result, "wall time [s], median of the runs", seconds_of);
}

LogPlot error_against_evaluations(const ProblemResult& result) {
  return error_plot(result, "force evaluations per particle", evaluations_of);
}

Status write_accuracy(const std::vector<ProblemResult>& results,
                      const std::filesystem::path& folder) {
  if (Status done = write_table(solutions_table(results), folder, "accuracy",
                                "# Run time against error: all solutions");
      !done) {
    return done;
  }
  if (Status done = write_table(cheapest_table(results), folder, "cheapest",
                                "# Run time against error: the cheapest methods");
      !done) {
    return done;
  }
  if (Status done = write_table(control_table(results), folder, "control",
                                "# Run time against error: varied steps against the best fixed");
      !done) {
    return done;
  }
  for (const ProblemResult& result : results) {
    Status done = write_plot(error_against_seconds(result), folder, result.name + "-time");
    if (!done) return done;
    done = write_plot(error_against_evaluations(result), folder, result.name + "-evaluations");
    if (!done) return done;
  }
  return {};
}

}  // namespace vat::bench
