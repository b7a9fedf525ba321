#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/table.h"

/// Counts of instructions that a check compares with: a CSV file with the columns scene, build and
/// instructions.
namespace vat::bench {

/// How many instructions a run of a scene took.
struct InstructionCount {
  std::string scene;
  std::uint64_t instructions = 0;
};

/// Compiler and flags of this program: counts of another build say nothing.
std::string this_build();

/// By how much a count may differ from the stored one [%].
inline constexpr std::uint64_t kMaxChange = 3;

/// The counts of all builds.
struct StoredCount {
  std::string build;
  InstructionCount count;
};
/// Fails where the file is no such file.
Result<std::vector<StoredCount>> read_stored_counts(const CsvFile& file);

/// An error for each count that is not stored for the build, or differs by more than kMaxChange to
/// either side; it says how to renew the file.
Status check_counts(const std::vector<InstructionCount>& counts,
                    const std::vector<StoredCount>& stored, const std::string& build);

/// The file with these counts in place of its own; those of other builds stay.
Table renewed(const std::vector<InstructionCount>& counts, const std::vector<StoredCount>& stored,
              const std::string& build);

}  // namespace vat::bench
