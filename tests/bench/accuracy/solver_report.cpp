#include "tests/bench/accuracy/solver_report.h"

#include <algorithm>
#include <utility>

#include "tests/bench/report/quantile.h"
#include "tests/validation/cases/liquid/liquid_solvers.h"

namespace vat::bench {

namespace {

using namespace validation;

constexpr const char* kColumn = "column-solvers";
constexpr const char* kDamBreak = "dam-break-solvers";
constexpr std::array kSolvers = {PressureSolver::tait, PressureSolver::incompressible};

template <class Solve>
SolverResult median_of(int repetitions, Solve&& solve) {
  std::vector<double> seconds;
  SolverResult result;
  for (int n = 0; n < repetitions; ++n) {
    result = solve();
    seconds.push_back(result.seconds);
  }
  result.seconds = median(std::move(seconds));
  return result;
}

SolverResult result_of(const char* problem, const char* error_name, Real error,
                       PressureSolver solver, int layers, const SolverRun& of) {
  return {
      problem,         error_name,          solver,           layers,         error,
      of.density.mean, of.density.greatest, of.run.seconds(), of.run.steps(), of.run.state_hash()};
}

StartRun starter_with(TaskRunner* runner) {
  return [runner](const Scene& scene) { return Run(scene, runner); };
}

SolverResult solve_column(PressureSolver solver, int layers, TaskRunner* runner) {
  const ColumnRun column = run_column(solver, layers, starter_with(runner));
  return result_of(kColumn, "pressure, L2", column.pressure_error(), solver, layers, column);
}

SolverResult solve_dam_break(PressureSolver solver, int layers, TaskRunner* runner) {
  const DamBreakRun result = run_dam_break(solver, layers, starter_with(runner));
  return result_of(
      kDamBreak, "front and height, RMS",
      std::hypot(best_front_error(result.seen.front), height_error(result.seen.height)), solver,
      layers, result);
}

}  // namespace

std::vector<SolverResult> compare_solvers(int repetitions, int finest, TaskRunner* runner) {
  std::vector<SolverResult> results;
  for (const PressureSolver solver : kSolvers) {
    for (const int layers : {10, 14, 20, 28, 40}) {
      if (layers > finest) continue;
      results.push_back(
          median_of(repetitions, [&] { return solve_column(solver, layers, runner); }));
      results.push_back(
          median_of(repetitions, [&] { return solve_dam_break(solver, layers, runner); }));
    }
  }
  std::ranges::stable_sort(results, {}, &SolverResult::problem);
  return results;
}

Table solvers_table(const std::vector<SolverResult>& results) {
  Table table{{"problem", "solver", "layers", "error of", "error", "mean density error",
               "greatest density error", "steps", "seconds", "hash"},
              {}};
  for (const SolverResult& result : results) {
    table.rows.push_back({result.problem, std::string(to_string(result.solver)),
                          static_cast<std::uint64_t>(result.layers), result.error_name,
                          result.error, result.mean_density_error, result.greatest_density_error,
                          result.steps, result.seconds, hash_text(result.hash)});
  }
  return table;
}

LogPlot solvers_plot(const std::vector<SolverResult>& results, const std::string& problem) {
  LogPlot plot{.title = problem,
               .x_label = "wall time [s], median of the runs",
               .y_label = {},
               .series = {}};
  for (const PressureSolver solver : kSolvers) {
    Series series{.label = to_string(solver), .points = {}, .colour = plot.series.size()};
    for (const SolverResult& result : results) {
      if (result.problem != problem || result.solver != solver) continue;
      series.points.push_back({result.seconds, result.error});
      plot.y_label = "relative error of the " + result.error_name;
    }
    plot.series.push_back(series);
  }
  return plot;
}

Status write_solvers(const std::vector<SolverResult>& results,
                     const std::filesystem::path& folder) {
  Status done = write_table(solvers_table(results), folder, "solvers",
                            "# Run time against error: pressure solvers");
  for (const char* problem : {kColumn, kDamBreak}) {
    if (done) done = write_plot(solvers_plot(results, problem), folder, problem);
  }
  return done;
}

}  // namespace vat::bench
