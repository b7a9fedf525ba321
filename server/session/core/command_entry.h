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

/// Returns the log entry of a command. The entry contains the content of scenes and saved states
/// instead of their names, because the named content can change later.
std::variant<CommandEntry, RpcError> make_command_entry(const SessionContext& context,
                                                        const SessionHistory& history,
                                                        const ParticipantCommand& command);

}  // namespace vat
