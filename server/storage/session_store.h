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

/// Progress of a session, stored at intervals. A recovery reaches it and compares the hash.
struct SessionProgress {
  std::uint64_t position = 0;  ///< as in a LogEntry
  std::uint64_t tick = 0;
  std::uint64_t sequence = 0;  ///< of the last executed entry
  std::uint64_t hash = 0;      ///< of the simulation's state
  std::uint32_t epoch = 0;
  bool playing = false;
  double speed = 1;
  std::string participants;  ///< JSON array of the participants
};

struct StoredSession {
  std::uint64_t number = 0;
  std::string name;
  std::string instruction_set;  ///< with which its hashes are valid
  std::string settings;         ///< JSON, an object
  std::uint64_t reached = 0;    ///< greatest position that a client was told of
  std::optional<SessionProgress> progress;
};

/// Sessions and their logs. Writes are complete when a call returns, and survive the end of the
/// process at any moment. Safe to use from any thread; throws StorageError.
class SessionStore {
 public:
  explicit SessionStore(const std::string& path);

  /// The database of the sessions, which other data shares.
  const std::shared_ptr<MainDatabase>& main() const { return main_; }

  /// Creates a session with its first entry, of sequence 1, and returns its number. Numbers are not
  /// used again.
  std::uint64_t create(const StoredSession& session, const LogEntry& first);
  /// Returns all open sessions, in ascending order of their numbers.
  std::vector<StoredSession> sessions();
  void configure(std::uint64_t session, const std::string& name, const std::string& settings);
  /// Closes a session, which is then not recovered. remove_closed() frees its data, which takes
  /// long.
  void close(std::uint64_t session);
  /// Frees the data of closed sessions, and returns their numbers.
  std::vector<std::uint64_t> remove_closed();

  /// Appends all entries or none.
  void append(std::uint64_t session, std::span<const LogEntry> entries);
  void append(std::uint64_t session, const LogEntry& entry) { append(session, {&entry, 1}); }
  /// Marks an entry that changed nothing.
  void refuse(std::uint64_t session, std::uint64_t sequence);
  /// Returns the next entries after a sequence, some hundred at most. Empty at the end of the log.
  std::vector<LogEntry> read(std::uint64_t session, std::uint64_t after);
  std::optional<LogEntry> find(std::uint64_t session, std::uint64_t sequence);
  std::uint64_t last_sequence(std::uint64_t session);  ///< 0: no entries
  std::size_t log_bytes(std::uint64_t session);
  /// Removes entries up to `last`, except `kept`, which later ones need.
  void trim(std::uint64_t session, std::uint64_t last, std::uint64_t kept);

  void write_progress(std::uint64_t session, const SessionProgress& progress);
  /// A recovery will reach at least this position.
  void reach(std::uint64_t session, std::uint64_t position);

  /// See Database::move_log(). Uses a separate connection. By one thread at a time.
  std::size_t move_log(bool wait) { return mover_.move_log(wait); }
  /// For tests: limits the size, as a full disk does.
  void limit_pages(std::size_t pages);

 private:
  /// The caller must hold the mutex.
  void insert(std::uint64_t session, const LogEntry& entry);
  /// Removes some of the entries for trim(). Returns false if there are none.
  bool trim_some(std::uint64_t session, std::uint64_t last, std::uint64_t kept);

  const std::shared_ptr<MainDatabase> main_;
  std::mutex& mutex_;
  Database& database_;
  Database mover_;
  Statement insert_entry_;
  Statement write_progress_;
  Statement write_reached_;
};

}  // namespace vat
