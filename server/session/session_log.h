#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "server/session/session_moment.h"
#include "server/session/tick_clock.h"
#include "server/storage/storage.h"

namespace vat {

/// The entry by which a participant leaves, and its grabs end.
inline constexpr std::string_view kLeaveEntry = "leave";
/// The entry by which its grabs end alone.
inline constexpr std::string_view kLetGoEntry = "let_go";

/// When a checkpoint is worth its cost. What is done again after a crash is bounded, and so is the
/// share of the time that checkpoints take.
class CheckpointPace {
 public:
  using Seconds = std::chrono::duration<double>;
  static constexpr double kGreatestShare = 0.05;    ///< of the work that ticks and commands are
  static constexpr Seconds kMaxWork = Seconds(10);  ///< without one, whatever one costs

  /// `wanted` is how much work there should be between two, where they are cheap enough.
  explicit CheckpointPace(Seconds wanted) : wanted_(wanted) {}

  /// The session has worked for so long.
  void add_work(Seconds time) { work_ += time; }
  /// Whether there has been enough since the last one, which has cost so much.
  bool is_due(Seconds cost) const;
  void begin() { work_ = Seconds(0); }

 private:
  Seconds wanted_;
  Seconds work_{0};
};

/// What is kept of a session: the log of its commands, where it is, and checkpoints. Entries are in
/// the log when the call returns; all else is written by the storage's own thread. Used by one
/// thread at a time.
class SessionLog {
 public:
  /// Where a session is as its log is taken up.
  struct Place {
    std::uint64_t last = 0;  ///< the sequence of the last entry that there is
    std::uint64_t position = 0;
    bool needs_checkpoint =
        false;  ///< the log does not lead here: what comes needs a checkpoint to build on
  };
  SessionLog(Storage& storage, std::uint64_t session, const Place& place);

  /// Gives the entries their sequences, and writes all of them or none. Throws StorageError.
  void append(std::span<LogEntry> entries);
  /// Notes that an entry has changed nothing.
  void refuse(std::uint64_t sequence);
  /// The session will come back at this position or later. Throws StorageError.
  void reach(std::uint64_t position);
  std::uint64_t last() const { return last_; }
  /// What the session's owner has decided. Throws StorageError.
  void configure(const std::string& name, const std::string& settings);

  /// Whether the state is worth a hash here, which tells a replay at which tick it differs: after
  /// each tick, but where bodies sleep and a tick may cost less than its hash.
  static bool is_hash_due(const Simulation& simulation, std::uint64_t position) {
    return simulation.sleeping_body_count() == 0 || position % kSleepingHashInterval == 0;
  }
  /// Of the state after the tick that led to a position.
  void add_hash(std::uint64_t position, std::uint64_t hash) { hashes_.push_back({position, hash}); }
  void add_work(CheckpointPace::Seconds time) { pace_.add_work(time); }
  /// Whether the session should be looked at, because it is elsewhere than it was a second ago, or
  /// a checkpoint is due.
  /// `people` counts the changes of its participants.
  bool is_due(std::uint64_t position, std::uint64_t people, SteadyClock::time_point now) const;
  /// Writes where the session is, and a checkpoint if one is due, or `always`.
  void keep(SessionMoment moment, SteadyClock::time_point now, bool always = false);
  /// The same, always with a checkpoint; what is kept is then for `task`, on the storage's thread.
  void keep_and(SessionMoment moment, SteadyClock::time_point now,
                std::function<void(Storage&, std::uint64_t session)> task);
  /// The session has been closed: frees what it took, soon.
  void close() { storage_.remove_closed(); }

 private:
  /// Known to tasks of the storage's thread, which may outlive this.
  struct Writing {
    std::atomic<bool> under_way = false;
    std::atomic<double> checkpoint_cost = 0;  // [s]
    std::atomic<std::size_t> log_bytes = 0;
  };
  static constexpr std::uint64_t kSleepingHashInterval = 16;
  /// Does what may throw StorageError, which is counted.
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
  // Of the last moment that was kept.
  std::uint64_t kept_position_ = 0;
  std::uint64_t kept_last_ = 0;
  std::uint64_t kept_people_ = 0;
  SteadyClock::time_point kept_at_{};
  bool is_bent_;
  std::vector<TickHash> hashes_;  ///< that are not written yet
  const std::shared_ptr<Writing> writing_ = std::make_shared<Writing>();
};

}  // namespace vat
