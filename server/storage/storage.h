#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "server/storage/checkpoint_store.h"
#include "server/storage/data_folder.h"
#include "server/storage/journal.h"
#include "server/storage/recent_states.h"
#include "server/storage/saved/saved_scene_database.h"
#include "server/storage/saved/saved_state_database.h"
#include "server/storage/session_store.h"
#include "server/storage/sqlite/storage_settings.h"
#include "server/storage/storage_counts.h"
#include "server/storage/token_store.h"
#include "server/support/clock.h"
#include "server/support/token_bucket.h"

namespace vat {

/// Data folder of a server, with a journal (a thread that writes commands) and a thread for slow
/// work: checkpoints, removal of closed sessions, and copies of write-ahead logs.
class Storage {
 public:
  /// Opens or creates the folder. Throws StorageError.
  Storage(const std::string& folder, const StorageSettings& settings, Clock& clock);
  /// Completes all posted tasks.
  ~Storage();
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;

  const std::string& folder() const { return folder_.path(); }
  const StorageSettings& settings() const { return settings_; }
  SessionStore& sessions() { return sessions_; }
  /// Returns the thread for writes to sessions(), scenes() and tokens() in common transactions.
  Journal& journal() { return journal_; }
  CheckpointStore& checkpoints() { return checkpoints_; }
  RecentStates& recent_states() { return recent_states_; }
  SavedStateDatabase& states() { return states_; }
  SavedSceneDatabase& scenes() { return scenes_; }
  TokenStore& tokens() { return tokens_; }

  /// Runs a task on the storage's thread, in the order of the calls. Exceptions are logged.
  void post(std::function<void()> task);
  /// Waits until all posted tasks have run and all writes of the journal are complete.
  void flush();
  /// Frees the data of closed sessions.
  void remove_closed();
  /// Returns the counters for /metrics.
  StorageCounts counts() const;
  /// Counts a failed write.
  void count_failure() { ++failures_; }
  /// Counts the sessions that store their logs.
  void open_log() { ++open_logs_; }
  void close_log() { --open_logs_; }
  std::size_t open_logs() const { return open_logs_; }
  /// Returns whether the budget of StorageSettings::checkpoint_bytes_per_second admits a checkpoint
  /// now. The budget may be saved for a minute.
  bool admits_checkpoint();
  /// Counts a checkpoint, its processor time and its size, which the budget is charged with.
  void count_checkpoint(std::chrono::duration<double> cost, std::size_t bytes);
  void count_recent_state() { ++recent_states_written_; }

 private:
  void run(const std::function<void()>& task);
  void move_logs();
  void wait_to_move();

  const DataFolder folder_;
  const StorageSettings settings_;
  const Clock& clock_;
  SessionStore sessions_;
  CheckpointStore checkpoints_;
  RecentStates recent_states_;
  SavedStateDatabase states_;
  SavedSceneDatabase scenes_;
  TokenStore tokens_;
  Journal journal_;
  std::atomic<std::size_t> open_logs_ = 0;
  std::atomic<std::uint64_t> failures_ = 0;
  std::atomic<std::uint64_t> checkpoints_written_ = 0;
  std::atomic<std::uint64_t> checkpoint_nanoseconds_ = 0;
  std::atomic<std::uint64_t> checkpoint_bytes_ = 0;
  std::atomic<std::uint64_t> recent_states_written_ = 0;
  std::mutex budget_mutex_;
  TokenBucket checkpoint_budget_;
  boost::asio::thread_pool thread_{1};
  // Members that only the storage's thread uses.
  const std::unique_ptr<Timer> move_timer_;
  bool stopping_ = false;
};

}  // namespace vat
