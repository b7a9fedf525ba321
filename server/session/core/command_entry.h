#pragma once

#include <optional>
#include <variant>

#include "server/session/core/session_command.h"
#include "server/session/core/session_history.h"

namespace vat {

/// Log entry of a command, and the action to execute.
struct CommandEntry {
  LogEntry entry;
  std::optional<SessionAction> action;  ///< if present, replaces the command's action
};

/// Returns whether the command names a saved scene or state. Its log entry then contains the saved
/// data, because the named data can change later.
bool names_saved_data(const SessionEnvironment& environment, const SessionCommand& command);

/// Reads the saved data that a command of the session names. Called on a storage thread.
CommandResolution resolve_command(const SessionEnvironment& environment, const std::string& session,
                                  const SessionCommand& command);

/// Returns the log entry of a command. A command that names saved data must be resolved.
std::variant<CommandEntry, RpcError> make_command_entry(const SessionEnvironment& environment,
                                                        const SessionHistory& history,
                                                        const ParticipantCommand& command);

}  // namespace vat
