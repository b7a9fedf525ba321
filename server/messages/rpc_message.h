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

/// JSON-RPC 2.0 messages and the errors of PROTOCOL.md.
namespace vat {

/// Error of a reply. `data` is added to its `kind` and `hint`, for example `path`: the pointer of
/// an invalid parameter.
struct RpcError {
  ErrorKind kind;
  std::string message;  ///< for users
  Json data = Json::object();
};

// Errors of the kinds in error_rows(). Names of methods, sessions and scenes may contain any text;
// they are made printable.

/// `error` is that of parse_json(). Its code becomes `data.reason`.
RpcError parse_failed(const Error& error);
RpcError invalid_request(std::string message);
RpcError method_not_found(std::string_view method);
/// `errors` must not be empty. Paths are pointers into `params`.
RpcError invalid_params(const Errors& errors);
/// Fault of this program. Only the log describes it.
RpcError internal_error();
RpcError not_joined();
/// Without a path: the session has ended while a command waited.
RpcError no_such_session(std::string_view session, std::string_view path = {});
RpcError no_such_body(std::string message, const std::string& path);
RpcError no_such_scene(std::string_view scene, std::string_view path = "/scene");
/// The session has no saved state with this name, the parameter `name`.
RpcError no_such_state(std::string_view name);
/// `limit` is the name in server.info's `limits`, and `maximum` its value.
RpcError limit_reached(std::string_view limit, std::size_t maximum);
RpcError limit_reached(const LimitExcess& excess);
RpcError not_allowed(std::string message);
/// The role of the caller is below the least role of the method.
RpcError role_too_low(std::string_view method, Role role, Role least);
RpcError not_authenticated(std::string message);
/// Another participant holds the body.
RpcError held_by_other(std::uint64_t participant, const std::string& name);
/// A command could not be stored, and was not executed.
RpcError storage_failed(StorageError::Kind reason);
/// `state` is "recovering" or "lost".
RpcError not_recovered(std::string_view session, std::string_view state);
/// `limit` is the name in server.info's `limits`, `maximum` its value, and `retry_after` is in
/// seconds.
RpcError rate_limited(std::string_view limit, double maximum, double retry_after);
/// Error of the core: no_such_body has its own kind, all others are invalid_params.
RpcError refused(const Errors& errors);

/// Content of a reply: its `result`, an object, or its `error`.
using RpcResult = std::variant<Json, RpcError>;

/// A request of valid form. Its method may be unknown.
struct RpcRequest {
  std::optional<Json> id;  ///< a string of at most 64 bytes or an integer; absent: a notification
  std::string method;
  Json params;  ///< an object; empty if the message has none
};

/// Returns the request in a parsed message, or the error. Sets `id` as soon as a valid one is
/// found, so that an error can be answered to it.
std::variant<RpcRequest, RpcError> read_request(Json message, std::optional<Json>& id);

/// Return the text of a message to a client. A reply to an unreadable message has the id null.
std::string write_reply(const Json& id, const RpcResult& result);
std::string write_event(std::string_view event, Json params);

}  // namespace vat
