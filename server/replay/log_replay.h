#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <stdexcept>

#include "server/session/core/session_core.h"

/// Repetition of a session's log in a SessionCore.
namespace vat {

/// Exception: the repeated log results in a different state.
class Diverged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Exception: the repetition was cancelled.
class Cancelled : public std::exception {};

/// Returns the parameters of a log entry. Throws StorageError (kind `corrupt`).
Json parse_entry_params(const LogEntry& entry);

/// Returns a new simulation of the scene that a log entry loads. Throws StorageError (kind
/// `corrupt`) if the scene is invalid within the environment's limits.
Simulation load_entry_scene(const LogEntry& entry, const SessionEnvironment& environment,
                            InstructionSet instructions);

/// Continues a simulation on the device of its scene; see resume_device(). Throws StorageError
/// (kind `failed`) if this machine lacks the device.
void resume_on_device(Simulation& simulation, const Scene& scene,
                      const SessionEnvironment& environment);

/// Executes a log entry. Throws Diverged if the entry is refused but was accepted before. Throws
/// StorageError (kind `corrupt`) if this program cannot read the entry.
void repeat_entry(SessionCore& core, const LogEntry& entry);

/// Executes a log entry of a recording, like repeat_entry(). An entry that only sets the clock has
/// no effect, because a replay has its own clock.
void repeat_recorded_entry(SessionCore& core, const LogEntry& entry);

/// Runs ticks up to a position. Throws Diverged if the guard fails, and Cancelled if `cancelled` is
/// true.
void run_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);

}  // namespace vat
