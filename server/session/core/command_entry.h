#pragma once

#include <optional>
#include <variant>

#include "server/session/core/session_command.h"
#include "server/session/core/session_history.h"

namespace vat {

/// Log entry of a command.
struct CommandEntry {
  LogEntry entry;
  std::optional<SessionAction> action;  ///< replaces the command's own action
};

/// Returns the entry of a logged command. The entry does not depend on the catalogue or on saved
/// scenes and states, which can change later: it contains their content in place of their name.
std::variant<CommandEntry, RpcError> make_command_entry(const SessionContext& context,
                                                        const SessionHistory& history,
                                                        const ParticipantCommand& command);

}  // namespace vat
