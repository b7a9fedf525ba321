#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/accuracy/measure.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// All solutions of one problem.
struct ProblemResult {
  std::string name;
  std::string title;
  std::string error_name;
  std::vector<Solution> solutions;
};

/// Returns one row per solution. Everything except the seconds is the same on all machines.
Table solutions_table(const std::vector<ProblemResult>& results);
/// Returns the cheapest method for each problem and target error, by evaluations and by wall time.
Table cheapest_table(const std::vector<ProblemResult>& results);

LogPlot error_against_seconds(const ProblemResult& result);
LogPlot error_against_evaluations(const ProblemResult& result);

/// Writes the tables of solutions and cheapest methods, and two plots per problem.
Status write_accuracy(const std::vector<ProblemResult>& results,
                      const std::filesystem::path& folder);

}  // namespace vat::bench
