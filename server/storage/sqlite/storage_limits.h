#pragma once

#include <chrono>
#include <cstddef>

namespace vat {

/// Greatest sizes of a session's stored data.
struct StorageLimits {
  /// Sufficient for five minutes of some thousand particles without thinning.
  std::size_t checkpoint_bytes = std::size_t{128} << 20;
  std::size_t log_bytes = std::size_t{64} << 20;  ///< of commands; the oldest are removed
  /// Work of a session between two checkpoints, if their cost allows it. Bounds the work that a
  /// recovery or a seek repeats.
  std::chrono::milliseconds checkpoint_after{100};
};

}  // namespace vat
