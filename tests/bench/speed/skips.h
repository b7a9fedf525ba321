#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// Work that a step leaves out, timed in turn in a scene that leaves it out and in the same scene
/// without the skip. To add one, write a function that makes both scenes, and enter it into
/// kSkips of skips.cpp.
struct SkipPair {
  std::string name{};
  std::string what;  ///< is left out
  Scene with;        ///< the skip
  Scene without;
  SpeedSettings settings;
  /// The most that time with over time without may be, as far as anything is promised.
  std::optional<Real> most{};
};

/// Their names, in order.
std::vector<std::string> skip_names();
/// One of them, by its place.
SkipPair make_skip_pair(std::size_t index);

/// A pair and its rows: with the skip, and without, each for all numbers of threads.
struct SkipResult {
  SkipPair pair;
  std::vector<SpeedRow> with;
  std::vector<SpeedRow> without;
};

/// Names of the rows are NAME-with and NAME-without.
Result<SkipResult> measure_skip(SkipPair pair, const SpeedSetup& setup);

/// Wall times of a simulated second, and their ratio.
Table skip_table(const std::vector<SkipResult>& results);

}  // namespace vat::bench
