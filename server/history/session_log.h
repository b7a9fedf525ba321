#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/history/session_moment.h"
#include "server/history/session_replica.h"
#include "server/storage/storage.h"
#include "server/support/clock.h"

namespace vat {

/// Method name of the log entry that removes a participant and ends its grabs.
inline constexpr std::string_view kLeaveEntry = "leave";
/// Method name of the log entry that ends the grabs of a participant.
inline constexpr std::string_view kReleaseGrabsEntry = "let_go";

/// Decision when to write a checkpoint. Limits the work that a recovery repeats, and the share of
/// checkpoints in the computing time.
class CheckpointPace {
 public:
  using Seconds = std::chrono::duration<double>;
  static constexpr double kMaxShare = 0.05;  ///< greatest share of checkpoints in the work
  /// Greatest work between two checkpoints, regardless of their cost.
  static constexpr Seconds kMaxWork = Seconds(10);

  /// `wanted` is the work (computing time) of all sessions that a recovery of the server repeats,
  /// if the cost permits. Each of n sessions has an nth of it between two checkpoints.
  explicit CheckpointPace(Seconds wanted) : wanted_(wanted) {}

  /// Adds computing time of ticks and commands.
  void add_work(Seconds time) { work_ += time; }
  /// Returns whether a checkpoint is due. `cost` is the computing time of the last checkpoint, and
  /// `sessions` the number of sessions of the server.
  bool is_due(Seconds cost, std::size_t sessions) const;
  void begin() { work_ = Seconds(0); }

 private:
  Seconds wanted_;
  Seconds work_{0};
};

/// Stored log, progress and checkpoints of a session. The journal writes log entries and progress.
/// The storage's thread writes all other data. No function waits for the disk. Not thread-safe.
class SessionLog {
 public:
  /// State of the session at the opening of the log.
  struct Place {
    std::uint64_t last = 0;  ///< sequence of the last stored entry
    std::uint64_t position = 0;
    bool needs_checkpoint = false;    ///< the log alone cannot reproduce this state
    std::size_t log_bytes = 0;        ///< size of the stored entries
    CheckpointPace::Seconds work{0};  ///< computing time since the last stored state
  };
  /// The storage must outlive the log. Without a replica (null), the data folder has the only copy.
  /// Otherwise the data folder has a working copy for reads: an entry counts as stored if the
  /// replica has it.
  SessionLog(Storage& storage, std::uint64_t session, const Place& place,
             std::shared_ptr<SessionReplica> replica = nullptr);
  ~SessionLog() { storage_.close_log(); }
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;

  /// Assigns sequences to the entries, which follow the last stored entry.
  void number(std::span<LogEntry> entries) const;
  /// Stores all entries or no entry, and then calls `done`. If a checkpoint is needed first, stores
  /// nothing until the checkpoint is stored. There must be no other append() without confirm().
  void append(std::vector<LogEntry> entries, Journal::Done done);
  /// Confirms that append() has stored its `count` entries.
  void confirm(std::size_t count) { last_ += count; }
  /// Marks an entry as refused. A refused entry had no effect.
  void refuse(std::uint64_t sequence);
  /// Stores that a recovery must repeat at least the ticks up to this position.
  void reach(std::uint64_t position, Journal::Done done);
  std::uint64_t last() const { return last_; }
  bool is_replicated() const { return replica_ != nullptr; }
  /// Stores the progress in the replica, so that another machine knows the participants. Calls
  /// `done` at once if there is no replica.
  void store_people(SessionMoment moment, Journal::Done done);
  /// Returns whether another machine may run the session, so that this one must not.
  bool is_suspended() const { return replica_ != nullptr && !replica_->is_active(); }
  /// Stores the settings of the session's owner.
  void configure(std::string name, std::string settings, Journal::Done done);
  /// Returns an estimate of the time until an entry is stored, which few entries exceed.
  SteadyClock::duration expected_time() const { return storage_.journal().expected_time(); }

  /// Returns whether a hash of the state is stored at this position. With the hashes, a replay
  /// detects the first different tick. A hash is stored after each tick, and less often while
  /// bodies sleep, because a hash may then cost more than a tick.
  static bool is_hash_due(const Simulation& simulation, std::uint64_t position) {
    return simulation.sleeping_body_count() == 0 || position % kSleepingHashInterval == 0;
  }
  /// Adds the hash of the state after a tick. `position` is the position at the end of the tick.
  void add_hash(std::uint64_t position, std::uint64_t hash) { hashes_.push_back({position, hash}); }
  void add_work(CheckpointPace::Seconds time) { pace_.add_work(time); }
  /// Returns whether store() should be called. The session must have changed since the last call.
  /// In addition, the last call must be at least a second ago, or a state must be due.
  /// `people` counts the changes of the participants.
  bool is_due(std::uint64_t position, std::uint64_t people, SteadyClock::time_point now) const;
  /// Stores the progress. Also stores the state if it is due: as a checkpoint if the budget admits
  /// one, otherwise as a recent state. Stores a checkpoint in any case if `always` is true.
  void store(SessionMoment moment, SteadyClock::time_point now, bool always = false);
  /// Stores the progress and a checkpoint, also in the replica, and then calls `done`.
  void store_all(SessionMoment moment, SteadyClock::time_point now, std::function<void()> done);
  /// Stores the progress and a checkpoint, and then runs `task` on the storage's thread. The
  /// journal contains the progress by then.
  void store_then(SessionMoment moment, SteadyClock::time_point now,
                  std::function<void(Storage&, std::uint64_t session)> task);
  /// Frees the stored data of a closed session in the background.
  void close() { storage_.remove_closed(); }

 private:
  /// State shared with tasks of the storage's thread, which may outlive the log.
  struct Writing {
    std::atomic<bool> under_way = false;
    std::atomic<bool> needs_checkpoint = false;
    std::atomic<double> checkpoint_cost = 0;  // [s]
    std::atomic<std::size_t> log_bytes = 0;
  };
  static constexpr std::uint64_t kSleepingHashInterval = 16;
  enum class Stored { progress, recent_state, checkpoint };
  using Write = std::function<void(Journal::Done done)>;
  /// Returns a function that writes to the data folder.
  Write local(Journal::Write write) const;
  /// Returns a function that writes to the replica, if there is one, and then calls `write`.
  Write replicated(Write write,
                   std::function<void(SessionReplica&, Journal::Done)> replicate) const;
  /// Returns the state, which is not compressed.
  static Checkpoint write_state(Storage& storage, std::uint64_t session,
                                const SessionMoment& moment, Stored stored, Writing& writing);
  static void write_replica(Storage& storage, const SessionMoment& moment, Checkpoint state,
                            SessionReplica& replica, std::uint64_t mark, bool always);
  static void bound_log(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                        Writing& writing);
  Stored due() const;

  Storage& storage_;
  const std::uint64_t session_;
  const std::shared_ptr<SessionReplica> replica_;
  std::uint64_t last_;
  CheckpointPace pace_;
  // Values of the last stored moment.
  std::uint64_t stored_position_ = 0;
  std::uint64_t stored_last_ = 0;
  std::uint64_t stored_people_ = 0;
  SteadyClock::time_point stored_at_{};
  std::vector<TickHash> hashes_;  ///< hashes that are not stored yet
  const std::shared_ptr<Writing> writing_ = std::make_shared<Writing>();
};

}  // namespace vat
