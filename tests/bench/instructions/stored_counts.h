#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/table.h"

/// Stored instruction counts for comparison: a CSV file with the columns scene, build and
/// instructions.
namespace vat::bench {

/// The number of instructions of a scene's run.
struct InstructionCount {
  std::string scene;
  std::uint64_t instructions = 0;
};

/// Returns compiler and flags of this program. Counts of other builds are not comparable.
std::string this_build();

/// Permitted difference from the stored count [%].
inline constexpr std::uint64_t kMaxChange = 3;

/// A stored count of one build.
struct StoredCount {
  std::string build;
  InstructionCount count;
};
/// Returns the counts of all builds. Fails if the file has another format.
Result<std::vector<StoredCount>> read_stored_counts(const CsvFile& file);

/// Returns an error for each count that is not stored for this build, or differs by more than
/// kMaxChange. The error tells how to renew the file.
Status check_counts(const std::vector<InstructionCount>& counts,
                    const std::vector<StoredCount>& stored, const std::string& build);

/// Returns the stored counts with those of this build replaced.
Table renewed(const std::vector<InstructionCount>& counts, const std::vector<StoredCount>& stored,
              const std::string& build);

}  // namespace vat::bench
