#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/fanout/case.h"
#include "tests/bench/fanout/segments.h"

namespace vat::bench {

/// Segments of time with and without some viewers, in turns, in one server: what those who come do
/// to its ticks and to those who stay.
struct TurnsCase {
  std::string name;
  ViewerCounts staying{};
  ViewerCounts coming{};
};

/// One quantity in the segments of either kind.
struct TurnsResult {
  std::string name;
  std::string quantity;     ///< and its unit
  std::size_t staying = 0;  ///< viewers
  std::size_t coming = 0;   ///< the same
  Segments without;
  Segments with;
};

const std::vector<TurnsCase>& turns_cases();

/// The segments are as long as three periods of the scene's vat, so that each sees the same motion,
/// and follow one another as A B B A, so that what changes slowly counts for both alike. Viewers
/// give way to the server. The settings' time says how many segments there are. Throws
/// std::runtime_error where the server or the viewers fail.
std::vector<TurnsResult> run_turns(const TurnsCase& one, const FanoutSettings& settings);

}  // namespace vat::bench
