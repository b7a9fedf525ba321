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
#include "server/storage/main_database.h"

namespace vat {

/// Where a session was, told from time to time, so that it comes back about there and can be shown
/// to be the same.
struct SessionProgress {
  std::uint64_t position = 0;  ///< as in a LogEntry
  std::uint64_t tick = 0;
  std::uint64_t sequence = 0;  ///< of the last entry that had been applied
  std::uint64_t hash = 0;      ///< of the simulation's state
  std::uint32_t epoch = 0;
  bool playing = false;
  double speed = 1;
  std::string participants;  ///< JSON, an array: who took part
};

struct StoredSession {
  std::uint64_t number = 0;
  std::string name;
  std::string instruction_set;  ///< that its hashes hold for
  std::string settings;         ///< JSON, an object
  std::uint64_t reached = 0;    ///< a position that somebody was told of
  std::optional<SessionProgress> beat;
};

/// The sessions and their logs. What a call has written when it returns survives the end of the
/// process at any moment. Safe to use from any thread; throws StorageError.
class SessionStore {
 public:
  explicit SessionStore(const std::string& path);

  /// In which they are, with what else is kept there.
  const std::shared_ptr<MainDatabase>& main() const { return main_; }

  /// Numbers are never used again. The first entry is written with the session, its sequence 1.
  std::uint64_t create(const StoredSession& session, const LogEntry& first);
  /// All that are not closed, in the order of their numbers.
  std::vector<StoredSession> sessions();
  void configure(std::uint64_t session, const std::string& name, const std::string& settings);
  /// It does not come back from now on; what it takes is freed by remove_closed(), which takes its
  /// time.
  void close(std::uint64_t session);
  /// Which ones.
  std::vector<std::uint64_t> remove_closed();

  /// All entries or none.
  void append(std::uint64_t session, std::span<const LogEntry> entries);
  void append(std::uint64_t session, const LogEntry& entry) { append(session, {&entry, 1}); }
  /// Notes that the entry has changed nothing.
  void refuse(std::uint64_t session, std::uint64_t sequence);
  /// The next ones with a sequence above `after`, in their order, some hundred at most; none at the
  /// end of the log.
  std::vector<LogEntry> read(std::uint64_t session, std::uint64_t after);
  std::optional<LogEntry> find(std::uint64_t session, std::uint64_t sequence);
  std::uint64_t last_sequence(std::uint64_t session);  ///< 0: it has no entry
  std::size_t log_bytes(std::uint64_t session);
  /// Removes entries up to `last`, but `kept`, which later ones build on.
  void trim(std::uint64_t session, std::uint64_t last, std::uint64_t kept);

  void beat(std::uint64_t session, const SessionProgress& beat);
  /// It will come back at this position or later.
  void reach(std::uint64_t session, std::uint64_t position);

  /// See Database::move_log(); on a connection of its own, by one thread at a time.
  std::size_t move_log(bool wait) { return mover_.move_log(wait); }
  /// For tests: as on a disk that holds no more than this.
  void limit_pages(std::size_t pages);

 private:
  /// With the mutex held.
  void insert(std::uint64_t session, const LogEntry& entry);
  /// Some of those that trim() removes; false where there are none.
  bool trim_some(std::uint64_t session, std::uint64_t last, std::uint64_t kept);

  const std::shared_ptr<MainDatabase> main_;
  std::mutex& mutex_;
  Database& database_;
  Database mover_;
  Statement insert_entry_;
  Statement write_beat_;
  Statement write_reached_;
};

}  // namespace vat
