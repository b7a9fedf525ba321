#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// What is compared of a row of `speed.csv`.
struct TimedRow {
  std::string name, threads, instruction_set;  ///< which name the row
  Real wall_per_simulated = 0;
  Real ms_per_step = 0;
  Real least_ms_per_step = 0;
  std::string steps;
  std::string state_hash;
  std::string machine;  ///< model and number of cores
  std::string commit;

  bool is_same_run(const TimedRow& other) const;
  /// Such as "dam-break-1k-tait, 2 threads, avx2".
  std::string title() const;
};

/// Fails where a column is missing, a time is no positive number, or a row comes twice.
Result<std::vector<TimedRow>> timed_rows(const CsvFile& file);

/// The rows of two results beside each other.
struct Comparison {
  struct Pair {
    TimedRow before;
    TimedRow after;
    Real ratio = 0;        ///< of the wall time of a simulated second
    Real least_ratio = 0;  ///< the same by the least times: busy machines make medians worse
    bool slower = false;
    bool faster = false;
  };
  std::vector<Pair> pairs;
  std::vector<TimedRow> only_before;
  std::vector<TimedRow> only_after;

  std::size_t slower_count() const;
  Real mean_ratio() const;  ///< geometric
};

/// A pair is slower, or faster, where both of its ratios are so by more than `tolerance`, a share.
/// Fails where no row is in both.
Result<Comparison> compare_rows(const std::vector<TimedRow>& before,
                                const std::vector<TimedRow>& after, Real tolerance);

/// A row for each pair.
Table comparison_table(const Comparison& comparison);

}  // namespace vat::bench
