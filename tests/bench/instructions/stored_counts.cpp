#include "tests/bench/instructions/stored_counts.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <system_error>
#include <utility>

namespace vat::bench {

namespace {

const std::vector<std::string> kColumns = {"scene", "build", "instructions"};

constexpr const char* kHowToRenew =
    "; where that is meant, VAT_UPDATE_GOLDEN=1 ./vat test -R bench/instructions renews "
    "tests/golden/instructions.csv";

/// Returns the stored count, or 0 if there is none.
std::uint64_t find_stored(const std::vector<StoredCount>& stored, const std::string& scene,
                          const std::string& build) {
  const auto found = std::ranges::find_if(stored, [&](const StoredCount& one) {
    return one.build == build && one.count.scene == scene;
  });
  return found == stored.end() ? 0 : found->count.instructions;
}

}  // namespace

std::string this_build() {
  return VAT_BUILD;
}

Result<std::vector<StoredCount>> read_stored_counts(const CsvFile& file) {
  if (file.columns != kColumns) {
    return Error{"malformed", "", "must have the columns scene, build, instructions"};
  }
  std::vector<StoredCount> stored;
  for (const std::vector<std::string>& row : file.rows) {
    const std::string& text = row[2];
    StoredCount one{row[1], {row[0], 0}};
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, one.count.instructions);
    if (error != std::errc{} || rest != end || one.count.instructions == 0) {
      return Error{"malformed", "", "'" + text + "' must be a whole number above 0"};
    }
    stored.push_back(std::move(one));
  }
  return stored;
}

Status check_counts(const std::vector<InstructionCount>& counts,
                    const std::vector<StoredCount>& stored, const std::string& build) {
  Errors errors;
  for (const InstructionCount& count : counts) {
    const std::uint64_t expected = find_stored(stored, count.scene, build);
    if (expected == 0) {
      errors.push_back({"missing", count.scene, std::string("no count is stored") + kHowToRenew});
      continue;
    }
    const std::uint64_t difference =
        std::max(count.instructions, expected) - std::min(count.instructions, expected);
    if (100 * difference <= kMaxChange * expected) continue;
    const double change =
        static_cast<double>(count.instructions) / static_cast<double>(expected) - 1;
    char per_cent[32];
    std::snprintf(per_cent, sizeof per_cent, "%+.1f %%", 100 * change);
    errors.push_back({"changed", count.scene,
                      std::to_string(count.instructions) + " instructions, and " +
                          std::to_string(expected) + " are stored (" + per_cent + ", " +
                          std::to_string(kMaxChange) + " % may be)" + kHowToRenew});
  }
  return errors.empty() ? Status() : Status(errors);
}

Table renewed(const std::vector<InstructionCount>& counts, const std::vector<StoredCount>& stored,
              const std::string& build) {
  Table table{kColumns, {}};
  for (const InstructionCount& count : counts) {
    table.rows.push_back({count.scene, build, count.instructions});
  }
  for (const StoredCount& one : stored) {
    if (one.build == build) continue;
    table.rows.push_back({one.count.scene, one.build, one.count.instructions});
  }
  return table;
}

}  // namespace vat::bench
