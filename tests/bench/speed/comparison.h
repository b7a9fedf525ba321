#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// The compared columns of a row of `speed.csv`.
struct TimedRow {
  std::string name, threads, instruction_set;  ///< identify the row
  Real wall_per_simulated = 0;
  Real ms_per_step = 0;
  Real least_ms_per_step = 0;
  std::string steps;
  std::string state_hash;
  std::string machine;  ///< model and number of cores
  std::string commit;

  bool is_same_run(const TimedRow& other) const;
  /// Returns a title such as "dam-break-1k-tait, 2 threads, avx2".
  std::string title() const;
};

/// Returns the rows. Fails if a column is missing, a time is not a positive number, or a row occurs
/// twice.
Result<std::vector<TimedRow>> timed_rows(const CsvFile& file);

/// The rows of two results in pairs.
struct Comparison {
  struct Pair {
    TimedRow before;
    TimedRow after;
    Real ratio = 0;        ///< ratio of wall times per simulated second
    Real least_ratio = 0;  ///< ratio of minimum times, which are less affected by a busy machine
    bool slower = false;
    bool faster = false;
  };
  std::vector<Pair> pairs;
  std::vector<TimedRow> only_before;
  std::vector<TimedRow> only_after;

  std::size_t slower_count() const;
  Real mean_ratio() const;  ///< geometric mean
};

/// Compares rows. A pair is slower (or faster) if both of its ratios are so by more than the
/// fraction `tolerance`. Fails if no row is in both.
Result<Comparison> compare_rows(const std::vector<TimedRow>& before,
                                const std::vector<TimedRow>& after, Real tolerance);

/// Returns a row for each pair.
Table comparison_table(const Comparison& comparison);

}  // namespace vat::bench
