#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/sqlite/database.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// State of a session after its log up to a sequence and a position.
struct Checkpoint {
  std::uint64_t session = 0;
  std::uint64_t position = 0;       ///< as in a LogEntry
  std::uint64_t sequence = 0;       ///< of the last executed entry
  std::string fields;               ///< JSON object: state of the session other than its simulation
  std::vector<std::uint8_t> state;  ///< of the simulation
};

/// Position of a checkpoint, without its content.
struct CheckpointPlace {
  std::uint64_t row = 0;
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::size_t bytes = 0;  ///< its size in the database
};

/// Hash of a session's state when it reached a position, before commands at that position.
struct TickHash {
  std::uint64_t position = 0;  ///< as in a LogEntry
  std::uint64_t hash = 0;
};

/// Checkpoints of sessions, compressed, and hashes of their states. They have a separate database,
/// so that their writes do not delay commands. Safe to use from any thread; throws StorageError.
class CheckpointStore {
 public:
  /// Checkpoints of a session beyond `session_bytes` are thinned: see write().
  CheckpointStore(const std::string& path, std::size_t session_bytes);

  /// Writes a checkpoint. If the session then exceeds its size, removes older ones so that the
  /// remaining gaps grow evenly. Returns the size of the checkpoint.
  std::size_t write(const Checkpoint& checkpoint);
  /// In ascending order of positions, then sequences.
  std::vector<CheckpointPlace> places(std::uint64_t session);
  /// Returns nothing if it was removed meanwhile. Throws StorageError, of kind corrupt, if it is
  /// damaged.
  std::optional<Checkpoint> read(const CheckpointPlace& place);
  /// Adds hashes at increasing positions. Removes those `kMaxHashes` positions before.
  void write_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  /// In ascending order of positions. The first may be somewhat before `from`.
  std::vector<TickHash> hashes(std::uint64_t session, std::uint64_t from);
  std::size_t hash_count(std::uint64_t session);
  /// Removes the hashes behind a position, from which the session continues.
  void drop_hashes(std::uint64_t session, std::uint64_t behind);
  static constexpr std::size_t kMaxHashes = 2'000'000;  ///< eleven hours at 50 ticks a second

  /// Removes the checkpoints of all other sessions.
  void keep_only(const std::vector<std::uint64_t>& sessions);

  std::size_t move_log(bool wait) { return mover_.move_log(wait); }

 private:
  std::vector<CheckpointPlace> places_locked(std::uint64_t session);
  void insert_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  std::vector<TickHash> hashes_locked(std::uint64_t session, std::uint64_t from);
  void thin(std::uint64_t session);
  void remove_row(std::uint64_t row);

  const std::size_t session_bytes_;
  OwnedMutex mutex_;
  Database database_;
  Database mover_;
};

}  // namespace vat
