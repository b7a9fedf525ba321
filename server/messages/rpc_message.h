#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/json/json_reader.h"
#include "server/access/role.h"
#include "server/messages/error_table.h"
#include "server/storage/sqlite/storage_error.h"
#include "server/support/limit_excess.h"

/// JSON-RPC 2.0 messages, and the errors of PROTOCOL.md.
namespace vat {

/// Error of a reply. `data` contains members in addition to `kind` and `hint`, for example `path`
/// (JSON pointer of an invalid parameter).
struct RpcError {
  ErrorKind kind;
  std::string message;  ///< message for users
  Json data = Json::object();
};

// The functions below return errors of the kinds in error_rows(). Names of methods, sessions and
// scenes may contain any text, and are converted to printable text.

/// Returns an error for `error` of parse_json(). `data.reason` is the code of `error`.
RpcError parse_failed(const Error& error);
RpcError invalid_request(std::string message);
/// Returns the error with `name` in `data.suggestion` and in the message. Returns the error
/// unchanged if `name` is empty.
RpcError with_suggestion(RpcError error, const std::string& name);
RpcError method_not_found(std::string_view method);
/// Returns an error with all elements of `errors`, which must not be empty. Paths are JSON pointers
/// into `params`.
RpcError invalid_params(const Errors& errors);
/// Returns an error for a fault of this program. Details are only in the log.
RpcError internal_error();
RpcError not_joined();
/// Returns an error for the parameter `name`: another session of the cluster has this name.
RpcError name_in_use();
/// Returns an error for a missing session. Without a path, the session has ended while a command
/// waited.
RpcError no_such_session(std::string_view session, std::string_view path = {});
RpcError no_such_body(std::string message, const std::string& path);
RpcError no_such_scene(std::string_view scene, std::string_view path = "/scene");
/// Returns an error for a missing saved state. The path is the parameter `name`.
RpcError no_such_state(std::string_view name);
/// Returns an error for an exceeded limit. `limit` is the name in server.info's `limits`, and
/// `maximum` is the value.
RpcError limit_reached(std::string_view limit, std::size_t maximum);
RpcError limit_reached(const LimitExcess& excess);
RpcError not_allowed(std::string message);
/// Returns an error for a role below the least role of the method.
RpcError role_too_low(std::string_view method, Role role, Role least);
RpcError not_authenticated(std::string message);
/// Returns an error for a body that another participant has grabbed.
RpcError held_by_other(std::uint64_t participant, const std::string& name);
/// Returns an error for a command that could not be logged and was not executed.
RpcError storage_failed(StorageError::Kind reason);
/// Returns an error for a session that is not running. `state` is "recovering" or "lost".
RpcError not_recovered(std::string_view session, std::string_view state);
/// Returns an error for a session that another node of the cluster serves at this URL.
RpcError moved_to(std::string_view session, std::string_view url);
/// Returns an error for an exceeded rate. `limit` is the name in server.info's `limits`, `maximum`
/// is the value, and `retry_after` is in [s].
RpcError rate_limited(std::string_view limit, double maximum, double retry_after);
/// Converts errors of the core. no_such_body has its own kind, and all others are invalid_params.
RpcError refused(const Errors& errors);

/// Content of a reply: `result` (a JSON object) or `error`.
using RpcResult = std::variant<Json, RpcError>;

/// Request of valid form. The method may be unknown.
struct RpcRequest {
  std::optional<Json> id;  ///< at most 64 bytes or an integer; absent: a notification
  std::string method;
  Json params;  ///< JSON object; empty if the message has no parameters
};

/// Returns the request in a parsed message, or an error. Sets `id` even if another part of the
/// message is invalid, so that the error reply can contain the id.
std::variant<RpcRequest, RpcError> read_request(Json message, std::optional<Json>& id);

/// Return parts of the text of a message. The text is the beginning, the text of the result or of
/// the params, and a closing brace.
std::string begin_reply(const Json& id);
std::string begin_event(std::string_view event);
/// Returns the beginning of the text of `object` with another last member. The text is the
/// beginning, the text of the member's value, and a closing brace. `object` must not be empty.
std::string begin_object(const Json& object, std::string_view last_member);
/// Returns the text of a JSON value. Invalid UTF-8 is replaced.
std::string to_message_text(const Json& message);

/// Return the text of a message to a client. The reply to an unreadable message has the id null.
std::string write_reply(const Json& id, const RpcResult& result);
std::string write_event(std::string_view event, Json params);

}  // namespace vat
