#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/log_entry.h"
#include "server/storage/sqlite/main_database.h"

namespace vat {

/// Progress of a session, stored at intervals. A recovery repeats the log up to `position` and
/// compares the hash.
struct SessionProgress {
  std::uint64_t position = 0;  ///< see LogEntry
  std::uint64_t tick = 0;
  std::uint64_t sequence = 0;  ///< sequence of the last executed entry
  std::uint64_t hash = 0;      ///< hash of the simulation's state
  std::uint32_t epoch = 0;
  bool playing = false;
  double speed = 1;
  std::string participants;  ///< JSON array
};

struct StoredSession {
  std::uint64_t number = 0;
  std::string name;
  std::string instruction_set;  ///< instruction set for which the hashes are valid
  std::string settings;         ///< JSON object
  std::uint64_t reached = 0;    ///< greatest position known to a client
  std::optional<SessionProgress> progress;
};

/// Store of sessions and their logs. A write is complete when the function returns or, within a
/// transaction of the journal, with the end of the transaction. Thread-safe. Functions throw
/// StorageError.
class SessionStore {
 public:
  explicit SessionStore(const std::string& path, Durability durability = Durability::process);

  /// Returns the database of the sessions, which other stores share.
  const std::shared_ptr<MainDatabase>& main() const { return main_; }

  /// Creates a session with its first log entry (sequence 1). Returns the number of the session,
  /// which is chosen if it is 0. Chosen numbers are not used again.
  std::uint64_t create(const StoredSession& session, const LogEntry& first);
  /// Writes a session with its log, and replaces the stored session with this number, if any.
  void replace(const StoredSession& session, std::span<const LogEntry> entries);
  /// Returns all open sessions, in ascending order of their numbers.
  std::vector<StoredSession> sessions();
  void configure(std::uint64_t session, const std::string& name, const std::string& settings);
  /// Closes a session. A closed session is not recovered. remove_closed() frees its data.
  void close(std::uint64_t session);
  /// Frees the data of closed sessions, and returns their numbers. The function is slow.
  std::vector<std::uint64_t> remove_closed();

  /// Appends all entries or no entry.
  void append(std::uint64_t session, std::span<const LogEntry> entries);
  void append(std::uint64_t session, const LogEntry& entry) { append(session, {&entry, 1}); }
  /// Marks an entry as refused. A refused entry had no effect.
  void refuse(std::uint64_t session, std::uint64_t sequence);
  /// Returns the next entries after a sequence, at most 500. The result is empty at the end of the
  /// log.
  std::vector<LogEntry> read(std::uint64_t session, std::uint64_t after);
  std::optional<LogEntry> find(std::uint64_t session, std::uint64_t sequence);
  std::uint64_t last_sequence(std::uint64_t session);  ///< 0: the log is empty
  std::size_t log_bytes(std::uint64_t session);
  /// Removes the entries up to the sequence `last`. Does not remove `kept`, because later entries
  /// need it.
  void trim(std::uint64_t session, std::uint64_t last, std::uint64_t kept);
  /// Removes some of the entries for trim(). Returns false if no entries are left to remove.
  bool trim_some(std::uint64_t session, std::uint64_t last, std::uint64_t kept);

  void write_progress(std::uint64_t session, const SessionProgress& progress);
  /// Stores that a recovery must repeat at least the ticks up to this position.
  void reach(std::uint64_t session, std::uint64_t position);

  /// See Database::move_log(). Uses a separate connection. Must be called by one thread at a time.
  std::size_t move_log(bool wait) { return mover_.move_log(wait); }

 private:
  // The caller must hold the mutex for these functions.
  std::uint64_t insert(const StoredSession& session);
  void insert(std::uint64_t session, const LogEntry& entry);
  /// Frees some of the unused space. Returns false if there is no more.
  bool compact_some();

  const std::shared_ptr<MainDatabase> main_;
  std::recursive_mutex& mutex_;
  Database& database_;
  Database mover_;
  Statement insert_entry_;
  Statement write_progress_;
  Statement write_reached_;
};

}  // namespace vat
