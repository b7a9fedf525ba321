#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "server/storage/sqlite/storage_error.h"

namespace vat {

/// Counters of a server's writes since its start.
struct StorageCounts {
  std::uint64_t failures = 0;  ///< failed writes
  std::uint64_t checkpoints = 0;
  std::uint64_t checkpoint_bytes = 0;
  std::uint64_t recent_states = 0;
  std::chrono::duration<double> checkpoint_time{};  ///< processor time
  std::uint64_t journal_writes = 0;                 ///< completed writes of the journal
  std::uint64_t journal_commits = 0;                ///< transactions that contain these writes
  std::chrono::duration<double> commit_time{};      ///< time of these transactions
  std::optional<StorageError::Kind> failing;        ///< error of the journal's last write, if any
};

}  // namespace vat
