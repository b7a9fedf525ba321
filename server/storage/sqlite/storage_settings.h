#pragma once

#include <chrono>
#include <cstddef>

#include "server/storage/sqlite/durability.h"

namespace vat {

/// Durability of a server's stored data, and limits of a session's stored data.
struct StorageSettings {
  Durability durability = Durability::power;
  /// Size of all checkpoints [bytes]. Sufficient for five minutes of some thousand particles
  /// without thinning.
  std::size_t checkpoint_bytes = std::size_t{128} << 20;
  std::size_t log_bytes = std::size_t{64} << 20;  ///< [bytes]; the oldest commands are removed
  /// Computing time of a session between two checkpoints, if the cost of a checkpoint permits.
  /// Limits the work that a recovery or a seek repeats.
  std::chrono::milliseconds checkpoint_after{100};
};

}  // namespace vat
