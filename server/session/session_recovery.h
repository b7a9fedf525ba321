#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "server/session/session_core.h"
#include "server/storage/storage.h"

namespace vat {

/// A log that is carried out again leads elsewhere than it did.
class Diverged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Carries out an entry of a log again. Throws Diverged where it is refused and was not, and
/// StorageError, of kind corrupt, for one that this program cannot read.
void carry_out_again(SessionCore& core, const LogEntry& entry);
/// Thrown where a recovery is not wanted any more.
class Cancelled : public std::exception {};

/// Runs ticks up to a position. Throws Diverged where the guard ends one, and Cancelled.
void run_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);

/// Makes a session anew from what is stored of it: its newest checkpoint that can be read, and the
/// log from there on. It comes to where it was seen last, or was told to have come, and its state
/// is compared with what it was when it was seen.
class SessionRecovery {
 public:
  /// `environment` must not have limits on scenes: what was accepted is accepted again.
  /// What `cancelled` says from any thread is heeded at the next tick.
  SessionRecovery(Storage& storage, StoredSession stored, const SessionEnvironment& environment,
                  const std::atomic<bool>& cancelled);

  const StoredSession& stored() const { return stored_; }
  /// Where it goes on from. Throws StorageError where nothing is left to go on from, or this
  /// machine lacks the instructions that it runs with.
  Simulation begin();
  /// The rest, with a core that was made with what begin() gave: up to the end of the log. Where
  /// it leads elsewhere the core says so, and stands still.
  void finish(SessionCore& core);

 private:
  struct Start {
    SessionMoment moment;
    Snapshot as_loaded;
  };
  std::optional<Simulation> begin_at(const CheckpointPlace& place);
  Simulation begin_at_scene();
  Simulation load_scene(std::uint64_t sequence);
  void carry_out_log(SessionCore& core);
  /// Of the entries that were written last, those that were refused may not be marked so yet, for
  /// the server may have ended in between; nobody had an answer to them.
  void carry_out_at_end(SessionCore& core, const LogEntry& entry);
  /// Compares where that is the place at which the session was seen.
  void compare(SessionCore& core);

  Storage& storage_;
  const StoredSession stored_;
  const SessionEnvironment& environment_;
  const std::atomic<bool>& cancelled_;
  InstructionSet instructions_ = InstructionSet::baseline;
  std::optional<Start> start_;
};

}  // namespace vat
