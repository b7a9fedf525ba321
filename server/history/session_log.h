#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "server/history/session_moment.h"
#include "server/storage/storage.h"
#include "server/support/clock.h"

namespace vat {

/// Method name of the entry by which a participant leaves and its grabs end.
inline constexpr std::string_view kLeaveEntry = "leave";
/// Method name of the entry by which the grabs of a participant end.
inline constexpr std::string_view kReleaseGrabsEntry = "let_go";

/// Decides when a checkpoint is written. Limits the work that a recovery repeats, and the share of
/// time that checkpoints take.
class CheckpointPace {
 public:
  using Seconds = std::chrono::duration<double>;
  static constexpr double kMaxShare = 0.05;  ///< of checkpoints in the work of ticks and commands
  static constexpr Seconds kMaxWork =
      Seconds(10);  ///< between checkpoints, regardless of their cost

  /// `wanted`: work between two checkpoints, if their cost allows it.
  explicit CheckpointPace(Seconds wanted) : wanted_(wanted) {}

  /// Adds working time of the session.
  void add_work(Seconds time) { work_ += time; }
  /// Whether the work since the last checkpoint suffices. `cost`: time that the last one took.
  bool is_due(Seconds cost) const;
  void begin() { work_ = Seconds(0); }

 private:
  Seconds wanted_;
  Seconds work_{0};
};

/// Stored log, progress and checkpoints of a session. Entries are stored when the call returns. The
/// storage's thread writes all else. Used by one thread at a time.
class SessionLog {
 public:
  /// State of the session when its log is opened.
  struct Place {
    std::uint64_t last = 0;  ///< sequence of the last stored entry
    std::uint64_t position = 0;
    bool needs_checkpoint = false;  ///< the log alone cannot reproduce this state
  };
  SessionLog(Storage& storage, std::uint64_t session, const Place& place);

  /// Sets the sequences of the entries, and stores all of them or none. Throws StorageError.
  void append(std::span<LogEntry> entries);
  /// Marks an entry that changed nothing.
  void refuse(std::uint64_t sequence);
  /// A recovery will reach at least this position. Throws StorageError.
  void reach(std::uint64_t position);
  std::uint64_t last() const { return last_; }
  /// Stores the settings of the session's owner. Throws StorageError.
  void configure(const std::string& name, const std::string& settings);

  /// Whether a hash of the state is stored at this position. It tells a replay the first tick that
  /// differs. Stored after each tick, or less often while bodies sleep and a tick may cost less
  /// than its hash.
  static bool is_hash_due(const Simulation& simulation, std::uint64_t position) {
    return simulation.sleeping_body_count() == 0 || position % kSleepingHashInterval == 0;
  }
  /// Adds the hash of the state after the tick that ended at a position.
  void add_hash(std::uint64_t position, std::uint64_t hash) { hashes_.push_back({position, hash}); }
  void add_work(CheckpointPace::Seconds time) { pace_.add_work(time); }
  /// Whether store() should be called: the session has changed since a second ago, or a checkpoint
  /// is due. `people` counts the changes of its participants.
  bool is_due(std::uint64_t position, std::uint64_t people, SteadyClock::time_point now) const;
  /// Stores the progress, and a checkpoint if one is due, or `always`.
  void store(SessionMoment moment, SteadyClock::time_point now, bool always = false);
  /// Stores the progress and a checkpoint, and then runs `task` on the storage's thread.
  void store_then(SessionMoment moment, SteadyClock::time_point now,
                  std::function<void(Storage&, std::uint64_t session)> task);
  /// Frees the storage of a closed session, soon.
  void close() { storage_.remove_closed(); }

 private:
  /// Shared with tasks of the storage's thread, which may outlive this.
  struct Writing {
    std::atomic<bool> under_way = false;
    std::atomic<double> checkpoint_cost = 0;  // [s]
    std::atomic<std::size_t> log_bytes = 0;
  };
  static constexpr std::uint64_t kSleepingHashInterval = 16;
  /// Runs `write`, and counts a StorageError that it throws.
  template <class Write>
  void write_now(const Write& write);
  static void write(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                    bool with_checkpoint, Writing& writing);
  static void bound_log(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                        Writing& writing);
  bool is_checkpoint_due() const;

  Storage& storage_;
  const std::uint64_t session_;
  std::uint64_t last_;
  CheckpointPace pace_;
  // Of the last stored moment.
  std::uint64_t stored_position_ = 0;
  std::uint64_t stored_last_ = 0;
  std::uint64_t stored_people_ = 0;
  SteadyClock::time_point stored_at_{};
  bool needs_checkpoint_;
  std::vector<TickHash> hashes_;  ///< not stored yet
  const std::shared_ptr<Writing> writing_ = std::make_shared<Writing>();
};

}  // namespace vat
