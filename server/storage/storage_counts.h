#pragma once

#include <chrono>
#include <cstdint>

namespace vat {

/// Counters of a server's writes since its start.
struct StorageCounts {
  std::uint64_t failures = 0;  ///< failed writes
  std::uint64_t checkpoints = 0;
  std::chrono::duration<double> checkpoint_time{};  ///< processor time
};

}  // namespace vat
