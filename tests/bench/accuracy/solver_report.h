#pragma once

#include <filesystem>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/parallel.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"

/// Comparison of the pressure solvers with their own wall treatment, at decreasing spacings.
namespace vat::bench {

/// A run of one solver.
struct SolverResult {
  std::string problem;
  std::string error_name;
  PressureSolver solver = PressureSolver::tait;
  int layers = 0;
  Real error = 0;
  Real mean_density_error = 0;
  Real greatest_density_error = 0;
  double seconds = 0;  ///< median of the repetitions
  std::uint64_t steps = 0;
  std::uint64_t hash = 0;
};

/// Runs all solvers. `repetitions` of each run determine the time. `finest` is the largest number
/// of layers.
std::vector<SolverResult> compare_solvers(int repetitions, int finest, TaskRunner* runner);

Table solvers_table(const std::vector<SolverResult>& results);
/// Returns a plot of error against seconds for one problem, with a line per solver.
LogPlot solvers_plot(const std::vector<SolverResult>& results, const std::string& problem);

/// Writes the table, and a plot per problem.
Status write_solvers(const std::vector<SolverResult>& results, const std::filesystem::path& folder);

}  // namespace vat::bench
