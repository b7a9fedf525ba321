#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/support/check.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"
#include "server/messages/method_row.h"
#include "server/people/participants.h"
#include "server/people/session_settings.h"

namespace vat {

class SessionCore;
class SessionView;

/// Number of ticks that control.step runs before the reply.
struct RunTicks {
  std::uint64_t count = 0;
};

/// Request for a recording of the session.
struct MakeRecording {};

/// Target position of replay.seek.
struct SeekTo {
  std::uint64_t position = 0;
};

/// Read or write of saved data, which may wait for the disk.
struct StorageWork {
  /// Returns the content of the reply, or an error. Called on a storage thread. May throw
  /// StorageError.
  std::function<RpcResult()> work;
};

/// Request for an invitation to the session.
struct IssueInvitation {
  Role role = Role::viewer;
  std::optional<std::size_t> uses;  ///< absent: unlimited
  std::chrono::seconds time{0};     ///< validity period
};

/// Request to store and apply settings of the session.
struct StoreSettings {
  SessionSettings settings;
};

/// Read whose result is computed later on another thread, because it may take long.
struct Read {
  bool needs_state = true;  ///< whether `make` uses the state of the simulation
  /// Returns the content of the reply, or an error. Must not use the session.
  std::function<RpcResult(SessionView&)> make;
  /// Text of the values that `make` has copied from the session. Equal requests with equal text
  /// share one result.
  std::string copied;
};

/// Result of an action: content of the reply, an error, or work before the reply. The session adds
/// the member `tick` to the content.
using ActionResult = std::variant<Json, RpcError, RunTicks, MakeRecording, SeekTo, StorageWork,
                                  IssueInvitation, StoreSettings, Read>;

/// Function that executes a command with valid parameters.
using SessionAction = std::function<ActionResult(SessionCore&, Participant&)>;

/// Saved data that a command names: parameters that contain the data instead of its name, and the
/// action to execute. Or the error of the command.
struct ResolvedCommand {
  std::string params;  ///< JSON object
  SessionAction action;
};
using CommandResolution = std::variant<ResolvedCommand, RpcError>;

/// Call of a session method with valid parameters.
// NOLINTNEXTLINE(bugprone-exception-escape): the library says that moves of JSON do not throw
struct SessionCommand {
  const MethodRow* row = nullptr;
  Json params;  ///< a JSON object
  SessionAction action;
  /// Result of resolve_command(), if the command names saved data.
  std::shared_ptr<const CommandResolution> resolution = nullptr;
};

/// Command, and the participant that sent it.
struct ParticipantCommand {
  ParticipantNumber participant = 0;
  const SessionCommand& command;
};

/// Method table as sessions use it. Implemented in server/rpc/.
struct SessionMethods {
  /// Returns the names of all methods, in the order of PROTOCOL.md.
  std::span<const std::string_view> names;
  /// Returns the properties of a method, or null if no method has this name.
  const MethodRow* (*find)(std::string_view method) = nullptr;
  /// Returns the command. Returns errors if no session method has this name or `params` are
  /// invalid.
  std::variant<SessionCommand, Errors> (*parse)(std::string_view method, Json params) = nullptr;

  /// Returns a command that the server itself issues. `params` must be valid.
  SessionCommand make(std::string_view method, Json params) const {
    VAT_CHECK(parse != nullptr);
    auto command = parse(method, std::move(params));
    VAT_CHECK(std::holds_alternative<SessionCommand>(command));
    return std::get<SessionCommand>(std::move(command));
  }
};

}  // namespace vat
