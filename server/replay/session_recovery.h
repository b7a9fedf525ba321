#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/session/core/session_core.h"
#include "server/storage/storage.h"

namespace vat {

/// Recovery of a stored session. Starts from the newest readable state (a recent state or a
/// checkpoint) and repeats the later
/// log, up to the last stored or reported position. Compares the state with the stored hash.
class SessionRecovery {
 public:
  /// `environment` must not limit scenes, so that all previously accepted commands are accepted
  /// again. `cancelled` is read at each tick. All arguments must outlive the recovery.
  SessionRecovery(Storage& storage, StoredSession stored, const SessionEnvironment& environment,
                  const std::atomic<bool>& cancelled);

  const StoredSession& stored() const { return stored_; }
  /// Returns the initial simulation of the SessionCore. Throws StorageError if no usable data is
  /// stored or this machine lacks the session's instruction set.
  Simulation begin();
  /// Repeats the log in the core. If the state differs, marks the session as diverged and pauses
  /// it. Throws Cancelled. Throws StorageError if the log is incomplete.
  void repeat_log(SessionCore& core);
  /// Ends the recovery. The session continues in `environment` and is stored again.
  void finish(SessionCore& core, const SessionEnvironment& environment);

 private:
  struct Start {
    SessionMoment moment;
    Snapshot as_loaded;
  };
  /// Returns the recent state if it is newer than the checkpoint `newest` and its commands are in
  /// the log. Removes the state otherwise.
  std::optional<Checkpoint> find_recent(const std::optional<CheckpointPlace>& newest);
  std::optional<Simulation> begin_at_place(const CheckpointPlace& place);
  std::optional<Simulation> begin_at(const Checkpoint& checkpoint);
  Simulation begin_at_scene();
  /// Returns the simulation at the beginning of the repeated log, without its device.
  Simulation find_begin();
  Simulation load_scene(std::uint64_t sequence);
  void execute_log(SessionCore& core);
  /// Throws Diverged if the CPU has repeated ticks of a device.
  void check_device_is_used(const SessionCore& core) const;
  /// Executes the last entry of the log. The mark of a refusal may be missing, because the server
  /// ended before writing it. No client has received a reply to such an entry.
  void repeat_last_entry(SessionCore& core, const LogEntry& entry);
  /// Compares the states if the position is that of the stored progress.
  void compare(SessionCore& core);

  Storage& storage_;
  const StoredSession stored_;
  const SessionEnvironment& environment_;
  const std::atomic<bool>& cancelled_;
  InstructionSet instructions_ = InstructionSet::baseline;
  std::optional<Start> start_;
  CheckpointPace::Seconds work_{0};     // of repeat_log()
  std::vector<std::uint64_t> refused_;  // sequences of entries that were not marked as refused
};

}  // namespace vat
