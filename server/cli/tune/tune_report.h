#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/tune/tuning.h"

namespace vat {

/// Texts of the results of `vat tune`.
struct TuneReport {
  const tune::CandidateSet& set;
  std::vector<tune::Outcome> outcomes;  ///< one for each candidate
  std::vector<tune::Point> points;      ///< completed candidates
  std::vector<tune::Point> front;       ///< Pareto front of `points`

  /// Returns the table of the front, and of the scene's own numerics if they are completed. Letters
  /// label the rows, and a star marks the scene's own numerics.
  std::string table() const;
  /// Returns the plot of error and time with logarithmic axes. It has the letters of the table, and
  /// dots for other completed candidates.
  std::string plot() const;
  /// Returns the numbers of candidates by outcome, in one line.
  std::string counts() const;
  /// Returns the label of a candidate in table and plot; a dot for candidates without a row.
  char label(std::size_t candidate) const;
};

}  // namespace vat
