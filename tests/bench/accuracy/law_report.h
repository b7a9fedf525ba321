#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/accuracy/accuracy_report.h"

/// Explicit springs against implicit ones, and penalties against projection: the same problem, the
/// same error, two laws.
namespace vat::bench {

/// A problem solved by two laws. Both live in the results that this came from.
struct LawPair {
  const ProblemResult* first = nullptr;
  const ProblemResult* second = nullptr;
  std::string first_law;
  std::string second_law;
};

/// Results whose names are BASE and BASE-implicit, or BASE and BASE-projection.
std::vector<LawPair> pairs_of_laws(const std::vector<ProblemResult>& results);

/// For each problem, law and target error the method that takes the least time.
Table laws_table(const std::vector<LawPair>& pairs);
/// Error against seconds, for each law what no other of its solutions is better than.
LogPlot laws_plot(const LawPair& pair);

/// Writes the table, and a plot a pair, BASE-laws; nothing where there are no pairs.
Status write_laws(const std::vector<LawPair>& pairs, const std::filesystem::path& folder);

}  // namespace vat::bench
