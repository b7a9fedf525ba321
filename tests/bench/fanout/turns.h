#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/fanout/case.h"
#include "tests/bench/fanout/segments.h"

namespace vat::bench {

/// Alternating time segments with and without additional viewers in one server. They show the
/// effect of these viewers on ticks and on the other viewers.
struct TurnsCase {
  std::string name;
  ViewerCounts staying{};
  ViewerCounts coming{};
};

/// One quantity in the segments of both kinds.
struct TurnsResult {
  std::string name;
  std::string quantity;     ///< with its unit
  std::size_t staying = 0;  ///< permanent viewers
  std::size_t coming = 0;   ///< additional viewers
  Segments without;
  Segments with;
};

const std::vector<TurnsCase>& turns_cases();

/// Runs a case. A segment takes three periods of the scene's vat, so that all segments contain the
/// same motion. They alternate as A B B A, so that slow changes affect both kinds equally. Viewers
/// have a lower priority than the server. The settings' time determines the number of segments.
/// Throws std::runtime_error if the server or the viewers fail.
std::vector<TurnsResult> run_turns(const TurnsCase& one, const FanoutSettings& settings);

}  // namespace vat::bench
