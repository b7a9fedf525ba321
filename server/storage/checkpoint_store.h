#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/sqlite/database.h"
#include "server/storage/sqlite/schema.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Stored state of a session after all log entries up to `sequence`, at `position`.
struct Checkpoint {
  std::uint64_t session = 0;
  std::uint64_t position = 0;       ///< see LogEntry
  std::uint64_t sequence = 0;       ///< sequence of the last executed log entry
  std::string fields;               ///< JSON object: session state except the simulation
  std::vector<std::uint8_t> state;  ///< state of the simulation
};

/// Greatest size of a state. The state of 200 000 particles has a third of it.
inline constexpr std::size_t kMaxStateBytes = std::size_t{1} << 30;

/// Location of a checkpoint, without its content.
struct CheckpointPlace {
  std::uint64_t row = 0;
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::size_t bytes = 0;  ///< size in the database
};

/// Hash of a session's state at a position, before the commands at this position.
struct TickHash {
  std::uint64_t position = 0;  ///< see LogEntry
  std::uint64_t hash = 0;
};

/// Store of compressed checkpoints and of state hashes. Uses a separate database, so that writes do
/// not delay commands. Writes survive a power failure. Thread-safe. Functions throw StorageError.
class CheckpointStore {
 public:
  /// `session_bytes` limits the size of a session's checkpoints, and `bytes_in_all` the size of all
  /// checkpoints; see write().
  CheckpointStore(const std::string& path, std::size_t session_bytes,
                  std::size_t bytes_in_all = std::numeric_limits<std::size_t>::max());

  /// Writes a checkpoint. If the session then exceeds its size, removes the checkpoints whose
  /// removal causes the smallest gaps. If all sessions together exceed their size, does the same
  /// for the session with the largest checkpoints. Keeps the newest checkpoint of each session.
  /// Returns the size of the checkpoint [bytes].
  std::size_t write(const Checkpoint& checkpoint);
  /// Returns the checkpoints in ascending order of position, then of sequence.
  std::vector<CheckpointPlace> places(std::uint64_t session);
  /// Returns the checkpoint, or nothing if the checkpoint was removed meanwhile. Throws
  /// StorageError (kind `corrupt`) if the checkpoint is damaged.
  std::optional<Checkpoint> read(const CheckpointPlace& place);
  /// Returns the checkpoint with its compressed state; see decompress(). The state may be damaged.
  std::optional<Checkpoint> read_compressed(const CheckpointPlace& place);
  /// Adds hashes at increasing positions. Removes hashes that are more than kMaxHashes positions
  /// older.
  void write_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  /// Returns hashes in ascending order of position. The first hashes may be slightly before `from`.
  std::vector<TickHash> hashes(std::uint64_t session, std::uint64_t from);
  std::size_t hash_count(std::uint64_t session);
  /// Removes the hashes after the position `behind`, at which the session continues.
  void drop_hashes(std::uint64_t session, std::uint64_t behind);
  static constexpr std::size_t kMaxHashes = 2'000'000;  ///< eleven hours at 50 ticks per second

  /// Removes the checkpoints and hashes of the session.
  void remove(std::uint64_t session);
  /// Removes the checkpoints and hashes of all other sessions, and frees their space on the disk.
  void keep_only(const std::vector<std::uint64_t>& sessions);

 private:
  std::vector<CheckpointPlace> places_locked(std::uint64_t session);
  void insert_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  std::vector<TickHash> hashes_locked(std::uint64_t session, std::uint64_t from);
  void thin(std::uint64_t session);
  void thin_all();
  /// Removes the checkpoint of the session whose removal causes the smallest gap.
  void remove_redundant(std::uint64_t session);
  void remove_row(std::uint64_t row);
  void remove_locked(std::uint64_t session);

  const std::size_t session_bytes_;
  const std::size_t bytes_in_all_;
  OwnedMutex mutex_;
  Database database_;
};

/// Returns the schema of the store's database.
Schema checkpoint_schema();

}  // namespace vat
