#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/bench/speed/measure.h"
#include "tests/bench/speed/skips.h"

namespace vat::bench {

/// A target and the measured value.
struct Target {
  std::string what;
  Real limit = 0;
  bool is_least = false;  ///< the limit is a minimum, not a maximum
  Real measured = 0;

  bool passed() const { return is_least ? measured >= limit : measured <= limit; }
};

/// Returns the targets that these rows can decide.
std::vector<Target> targets_of(const std::vector<SpeedRow>& rows,
                               const std::vector<SkipResult>& skips);

Table target_table(const std::vector<Target>& targets);

}  // namespace vat::bench
