#pragma once

#include <cstdint>
#include <vector>

#include "tests/bench/codec/recording.h"

namespace vat::bench {

/// Medians of the times of a frame at one level of detail.
struct ManyResult {
  std::uint8_t detail = 0;
  std::size_t particles = 0;
  Real bytes = 0;     ///< of a delta frame
  Real quantise = 0;  ///< [s]
  Real encode = 0;    ///< [s]
  Real decode = 0;    ///< [s]
};

/// Returns the times at each level of detail. They are those of a server with one client in one
/// thread, with two references for each frame. Throws std::runtime_error if a decoder gives other
/// integers.
std::vector<ManyResult> measure_many(const Recording& recording, Real max_error);

}  // namespace vat::bench
