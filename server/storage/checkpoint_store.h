#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/database.h"

namespace vat {

/// A session as it was: what its log leads to up to a sequence and a position.
struct Checkpoint {
  std::uint64_t session = 0;
  std::uint64_t position = 0;       ///< as in a LogEntry
  std::uint64_t sequence = 0;       ///< of the last entry that had been applied
  std::string fields;               ///< JSON, an object: what the session has beside its simulation
  std::vector<std::uint8_t> state;  ///< of the simulation
};

/// Where a checkpoint is, without its content.
struct CheckpointPlace {
  std::uint64_t row = 0;
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::size_t bytes = 0;  ///< that it takes here
};

/// What a session's state was as its run had come to a position, before anything was changed there.
struct TickHash {
  std::uint64_t position = 0;  ///< as in a LogEntry
  std::uint64_t hash = 0;
};

/// The sessions' checkpoints, compressed, and hashes of their states, in a database of their own,
/// so that writing one holds up no command. Safe to use from any thread; throws StorageError.
class CheckpointStore {
 public:
  /// Beyond `session_bytes` a session's checkpoints are thinned: see write().
  CheckpointStore(const std::string& path, std::size_t session_bytes);

  /// Where its session then has more than it may, older ones go, so that the gaps between those
  /// that stay grow alike. The bytes that it takes.
  std::size_t write(const Checkpoint& checkpoint);
  /// In the order of their positions, and of their sequences where these are the same.
  std::vector<CheckpointPlace> places(std::uint64_t session);
  /// Nothing where it was removed in the meantime. Throws what is of kind corrupt for one that is
  /// damaged.
  std::optional<Checkpoint> read(const CheckpointPlace& place);
  /// Adds hashes at positions that rise. Those that are `kMaxHashes` positions back go.
  void write_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  /// Rising by position; may begin somewhat before `from`.
  std::vector<TickHash> hashes(std::uint64_t session, std::uint64_t from);
  std::size_t hash_count(std::uint64_t session);
  /// Those behind a position go: the session goes on from there.
  void drop_hashes(std::uint64_t session, std::uint64_t behind);
  static constexpr std::size_t kMaxHashes = 2'000'000;  ///< eleven hours at 50 ticks a second

  /// Removes what is of all other sessions.
  void keep_only(const std::vector<std::uint64_t>& sessions);

  std::size_t move_log(bool wait) { return mover_.move_log(wait); }

 private:
  std::vector<CheckpointPlace> places_locked(std::uint64_t session);
  void insert_hashes(std::uint64_t session, std::span<const TickHash> hashes);
  std::vector<TickHash> hashes_locked(std::uint64_t session, std::uint64_t from);
  void thin(std::uint64_t session);
  void remove_row(std::uint64_t row);

  const std::size_t session_bytes_;
  std::mutex mutex_;
  Database database_;
  Database mover_;
};

}  // namespace vat
