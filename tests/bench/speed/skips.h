#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// Work that a step can skip, timed in turn in a scene with the skip and in the same scene without
/// it. To add one, write a function that makes both scenes, and add it to kSkips in skips.cpp.
struct SkipPair {
  std::string name{};
  std::string what;  ///< skipped work
  Scene with;        ///< scene with the skip
  Scene without;
  SpeedSettings settings;
  /// Maximum ratio of the time with the skip to that without, if one is promised.
  std::optional<Real> most{};
};

/// Returns the names in order.
std::vector<std::string> skip_names();
/// Returns the pair with this index.
SkipPair make_skip_pair(std::size_t index);

/// A pair and its rows with and without the skip, for all numbers of threads.
struct SkipResult {
  SkipPair pair;
  std::vector<SpeedRow> with;
  std::vector<SpeedRow> without;
};

/// Measures a pair. The names of its rows are NAME-with and NAME-without.
Result<SkipResult> measure_skip(SkipPair pair, const SpeedSetup& setup);

/// Returns wall times per simulated second and their ratio.
Table skip_table(const std::vector<SkipResult>& results);

}  // namespace vat::bench
