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
  /// Written bytes of the checkpoints of all sessions per second. The default is 13 GB per day.
  double checkpoint_bytes_per_second = 150'000;
  std::size_t log_bytes = std::size_t{64} << 20;  ///< [bytes]; the oldest commands are removed
  /// Computing time of all sessions between their states in storage, if the cost permits. Limits
  /// the work that a recovery of the server repeats.
  std::chrono::milliseconds checkpoint_after{2000};
};

}  // namespace vat
