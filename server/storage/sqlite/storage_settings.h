#pragma once

#include <chrono>
#include <cstddef>

#include "server/storage/sqlite/durability.h"

namespace vat {

/// Durability of a server's stored data, and limits of a session's stored data.
struct StorageSettings {
  Durability durability = Durability::power;
  std::size_t checkpoint_bytes = std::size_t{128} << 20;       ///< of one session [bytes]
  std::size_t checkpoint_bytes_in_all = std::size_t{4} << 30;  ///< of all sessions [bytes]
  /// Written bytes of the checkpoints of all sessions per second. The default is 15.6 GB per day.
  double checkpoint_bytes_per_second = 180'000;
  std::size_t log_bytes = std::size_t{64} << 20;  ///< [bytes]; the oldest commands are removed
  /// Computing time of a session between two checkpoints, if their cost and their bytes permit.
  /// Limits the work that a recovery repeats.
  std::chrono::milliseconds checkpoint_after{4000};
};

}  // namespace vat
