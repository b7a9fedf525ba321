#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "server/storage/sqlite/main_database.h"
#include "server/storage/storage_counts.h"
#include "server/support/clock.h"

namespace vat {

/// Thread that writes to the main database. All writes that wait at the same time share one
/// transaction, and with Durability::power one synchronisation with the disk. Thread-safe.
class Journal {
 public:
  /// Function that writes to the main database through a store. May throw StorageError. After a
  /// failure, the journal may call the function again.
  using Write = std::function<void()>;
  /// Function for the completion of a write, with the error if the write failed. A failed write has
  /// no effect. Must not wait.
  using Done = std::function<void(std::optional<StorageError::Kind> failure)>;

  /// The database and the clock must outlive the journal.
  Journal(MainDatabase& main, const Clock& clock);
  /// Completes all posted writes.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Writes and calls `done` on the journal's thread. The writes of all calls are executed in the
  /// order of the calls.
  void post(Write write, Done done = {});
  /// Waits until all posted writes are complete.
  void flush();

  /// Returns an estimate of the time from post() to the completion, which few writes exceed.
  SteadyClock::duration expected_time() const;
  /// Returns the counters of the journal. The other counters are zero.
  StorageCounts counts() const;

 private:
  struct Entry {
    Write write;
    Done done;
    SteadyClock::time_point posted_at;
  };
  using Group = std::vector<Entry>;
  using Failure = std::optional<StorageError::Kind>;

  void run();
  /// Executes the writes in one transaction. If the transaction fails, executes each write in a
  /// separate transaction.
  void write(Group& group);
  /// Returns the error if the transaction fails.
  Failure try_write(std::span<Entry> entries);
  void finish(std::span<Entry> entries, Failure failure);

  MainDatabase& main_;
  const Clock& clock_;

  mutable std::mutex mutex_;  // guards all members below except the thread
  std::condition_variable wakes_;
  std::condition_variable idle_;
  Group waiting_;
  std::uint64_t posted_ = 0;    // number of calls of post()
  std::uint64_t finished_ = 0;  // number of them that are complete
  bool stopping_ = false;
  StorageCounts counts_;
  // Mean and mean deviation of the times of recent writes [s], as in RFC 6298.
  double mean_time_ = 0;
  double time_deviation_ = 0;

  std::thread thread_;  // last, because it uses the other members
};

}  // namespace vat
