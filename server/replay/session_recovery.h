#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "server/session/core/session_core.h"
#include "server/storage/storage.h"

namespace vat {

/// Recovers a stored session from its newest readable checkpoint and the log after it, up to the
/// position where it was last stored or reported. Compares its state with the stored hash.
class SessionRecovery {
 public:
  /// `environment` must have no limits on scenes, because what was accepted before is accepted
  /// again. `cancelled` is read at each tick. All arguments must outlive this.
  SessionRecovery(Storage& storage, StoredSession stored, const SessionEnvironment& environment,
                  const std::atomic<bool>& cancelled);

  const StoredSession& stored() const { return stored_; }
  /// Returns the simulation to make the core with. Throws StorageError if nothing usable is stored,
  /// or this machine lacks the session's instruction set.
  Simulation begin();
  /// Repeats the log in that core. If the state differs, the core is diverged and paused. Throws
  /// Cancelled, and StorageError if the log is incomplete.
  void repeat_log(SessionCore& core);
  /// Continues the session in its own environment, stored from now on.
  void finish(SessionCore& core, const SessionEnvironment& environment);

 private:
  struct Start {
    SessionMoment moment;
    Snapshot as_loaded;
  };
  std::optional<Simulation> begin_at(const CheckpointPlace& place);
  Simulation begin_at_scene();
  Simulation load_scene(std::uint64_t sequence);
  void execute_log(SessionCore& core);
  /// Entries at the end of the log may lack the mark of a refusal, if the server ended before it
  /// was written. Nobody had an answer to them.
  void repeat_last_entry(SessionCore& core, const LogEntry& entry);
  /// Compares the state if this is the position of the stored progress.
  void compare(SessionCore& core);

  Storage& storage_;
  const StoredSession stored_;
  const SessionEnvironment& environment_;
  const std::atomic<bool>& cancelled_;
  InstructionSet instructions_ = InstructionSet::baseline;
  std::optional<Start> start_;
};

}  // namespace vat
