#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "server/session/method_rules.h"
#include "server/session/session_directory.h"

namespace vat {

/// A call whose parameters are read, to be made on the network's thread. A result is the answer at
/// once; without one, whoever took the caller answers.
using ServerAction = std::function<std::optional<RpcResult>(SessionDirectory&, PendingReply&)>;

/// A method of PROTOCOL.md: a reader of its parameters that gives what is then to be done, in the
/// server or in the session that the caller has joined. Readers only collect errors; an action is
/// not used if there are any.
struct Method {
  using ForServer = ServerAction (*)(ObjectReader& params, Errors& errors);
  using ForSession = SessionAction (*)(ObjectReader& params, Errors& errors);
  std::string_view name;
  std::variant<ForServer, ForSession> read;
  MethodRules rules{};  ///< the row of method_rules()
};

std::span<const Method> server_methods();
std::span<const Method> scene_methods();
std::span<const Method> session_methods();
std::span<const Method> control_methods();
std::span<const Method> world_methods();
std::span<const Method> edit_methods();
std::span<const Method> grab_methods();
std::span<const Method> frame_methods();
std::span<const Method> state_methods();
std::span<const Method> people_methods();
std::span<const Method> presence_methods();
std::span<const Method> access_methods();
std::span<const Method> replay_methods();
std::span<const Method> saved_methods();
std::span<const Method> admin_methods();

/// All of them, in the order of PROTOCOL.md.
const std::vector<Method>& all_methods();
/// Null if there is none.
const Method* find_method(std::string_view name);
/// A call of a session's method that the server makes itself; its params must be right.
SessionCommand make_command(std::string_view method, Json params);

}  // namespace vat
