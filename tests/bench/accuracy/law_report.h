#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/accuracy/accuracy_report.h"

/// Compares explicit with implicit springs, and penalties with projection, at the same problem and
/// error.
namespace vat::bench {

/// A problem solved with two laws. Both point into the given results.
struct LawPair {
  const ProblemResult* first = nullptr;
  const ProblemResult* second = nullptr;
  std::string first_law;
  std::string second_law;
};

/// Returns the pairs of results named BASE and BASE-implicit, or BASE and BASE-projection.
std::vector<LawPair> pairs_of_laws(const std::vector<ProblemResult>& results);

/// Returns the fastest method for each problem, law and target error.
Table laws_table(const std::vector<LawPair>& pairs);
/// Returns a plot of error against seconds with the Pareto front of each law.
LogPlot laws_plot(const LawPair& pair);

/// Writes the table, and a plot BASE-laws for each pair. Writes nothing if there are no pairs.
Status write_laws(const std::vector<LawPair>& pairs, const std::filesystem::path& folder);

}  // namespace vat::bench
