#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/support/check.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"
#include "server/messages/method_row.h"
#include "server/people/participants.h"

namespace vat {

class SessionCore;

/// Ticks that control.step runs before it is answered.
struct RunTicks {
  std::uint64_t count = 0;
};

/// Request for a recording of the session.
struct MakeRecording {};

/// Target position of replay.seek.
struct SeekTo {
  std::uint64_t position = 0;
};

/// Request to save the session's state under a name.
struct SaveState {
  std::string name;
  std::string saved_by;
};

/// Reply of a command, or work that the session does before it replies. A result gets its `tick`
/// afterwards.
using ActionResult = std::variant<Json, RpcError, RunTicks, MakeRecording, SeekTo, SaveState>;

/// Effect of a command whose parameters are valid.
using SessionAction = std::function<ActionResult(SessionCore&, Participant&)>;

/// Call of a session's method with valid parameters.
// NOLINTNEXTLINE(bugprone-exception-escape): the library says that moves of JSON do not throw
struct SessionCommand {
  const MethodRow* row = nullptr;
  Json params;  ///< an object
  SessionAction action;
};

/// Command of one participant.
struct ParticipantCommand {
  ParticipantNumber participant = 0;
  const SessionCommand& command;
};

/// The method table, as sessions use it. Implemented by server/rpc/.
struct SessionMethods {
  /// Names of all methods, in the order of PROTOCOL.md.
  std::span<const std::string_view> names;
  /// Returns null if no method has this name.
  const MethodRow* (*find)(std::string_view method) = nullptr;
  /// Returns the command, or errors if no session method has this name or `params` are invalid.
  std::variant<SessionCommand, Errors> (*parse)(std::string_view method, Json params) = nullptr;

  /// Returns a command that the server itself gives. `params` must be valid.
  SessionCommand make(std::string_view method, Json params) const {
    VAT_CHECK(parse != nullptr);
    auto command = parse(method, std::move(params));
    VAT_CHECK(std::holds_alternative<SessionCommand>(command));
    return std::get<SessionCommand>(std::move(command));
  }
};

}  // namespace vat
