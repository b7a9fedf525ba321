#pragma once

#include <chrono>
#include <cstdint>

namespace vat {

/// What a server has written since its start.
struct StorageCounts {
  std::uint64_t failures = 0;  ///< how often something could not be written
  std::uint64_t checkpoints = 0;
  std::chrono::duration<double> checkpoint_time{};  ///< of a processor, that writing them took
};

}  // namespace vat
