#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <stdexcept>

#include "server/session/core/session_core.h"

/// Repetition of a log in the core of a session.
namespace vat {

/// The repeated log leads to another state than before.
class Diverged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The repetition was cancelled.
class Cancelled : public std::exception {};

/// Returns the parameters of an entry. Throws StorageError, of kind corrupt.
Json parse_entry_params(const LogEntry& entry);

/// Returns a new simulation of the scene that an entry loads. Throws StorageError, of kind corrupt,
/// if that is not possible within the environment's limits.
Simulation load_entry_scene(const LogEntry& entry, const SessionEnvironment& environment,
                            InstructionSet instructions);

/// Executes an entry. Throws Diverged if it is refused now but was not before, and StorageError, of
/// kind corrupt, if this program cannot read it.
void repeat_entry(SessionCore& core, const LogEntry& entry);

/// Executes an entry of a recording, as repeat_entry() does. An entry that only sets the clock is
/// counted but has no effect: a replay has its own clock.
void repeat_recorded_entry(SessionCore& core, const LogEntry& entry);

/// Runs ticks up to a position. Throws Diverged if the guard fails, and Cancelled.
void run_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);

}  // namespace vat
