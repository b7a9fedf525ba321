#pragma once

#include <chrono>
#include <cstddef>

namespace vat {

/// How much is kept of each session.
struct StorageLimits {
  /// Five minutes of some thousand particles without thinning.
  std::size_t checkpoint_bytes = std::size_t{128} << 20;
  std::size_t log_bytes = std::size_t{64} << 20;  ///< of commands; then the oldest go
  /// How much work of a session there is between two checkpoints, where they are cheap enough: what
  /// is done again after a crash, and the most that going to any moment of its past takes.
  std::chrono::milliseconds checkpoint_after{100};
};

}  // namespace vat
