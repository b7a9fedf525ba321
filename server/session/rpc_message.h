#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/json/json_reader.h"
#include "server/access/role.h"
#include "server/session/error_table.h"
#include "server/storage/storage_error.h"

/// JSON-RPC 2.0 messages and the errors of PROTOCOL.md.
namespace vat {

/// A reply's error. `data` is what stands beside its `kind` and `hint`: a parameter that is at
/// fault by `path`, a pointer into `params`.
struct RpcError {
  ErrorKind kind;
  std::string message;  ///< for people
  Json data = Json::object();
};

// Errors of the kinds of error_rows(). The names of methods, sessions and scenes may be passed as
// the client gave them, and are made printable.

/// `error` is parse_json()'s: its code becomes `data.reason`.
RpcError parse_failed(const Error& error);
RpcError invalid_request(std::string message);
RpcError method_not_found(std::string_view method);
/// There must be at least one error; paths are pointers into `params`.
RpcError invalid_params(const Errors& errors);
/// A fault of this program; what it was belongs in the log, not in the reply.
RpcError internal_error();
RpcError not_joined();
/// Without a path: the session has ended under a command.
RpcError no_such_session(std::string_view session, std::string_view path = {});
RpcError no_such_body(std::string message, const std::string& path);
RpcError no_such_scene(std::string_view scene, std::string_view path = "/scene");
/// No state of the session is saved under this name, the parameter `name`.
RpcError no_such_state(std::string_view name);
/// `limit` is the name in server.info's `limits`, `maximum` its value.
RpcError limit_reached(std::string_view limit, std::size_t maximum);
RpcError not_allowed(std::string message);
/// The role of who called the method is below the least that may.
RpcError role_too_low(std::string_view method, Role role, Role least);
RpcError not_authenticated(std::string message);
/// Another participant holds the body.
RpcError held_by_other(std::uint64_t participant, const std::string& name);
/// A command could not be kept, and was not carried out.
RpcError storage_failed(StorageError::Kind reason);
/// `state` is "recovering" or "lost".
RpcError not_recovered(std::string_view session, std::string_view state);
/// `limit` is the name in server.info's `limits`, `maximum` its value, `retry_after` in seconds.
RpcError rate_limited(std::string_view limit, double maximum, double retry_after);
/// What the core refused: its no_such_body has an error of its own, all else is invalid_params.
RpcError refused(const Errors& errors);

/// What a reply carries: its `result`, an object, or its `error`.
using RpcResult = std::variant<Json, RpcError>;

/// A request of valid form; whether the method exists is not known yet.
struct RpcRequest {
  std::optional<Json> id;  ///< a string of at most 64 bytes or an integer; absent: a notification
  std::string method;
  Json params;  ///< an object, empty where the message has none
};

/// The request in a parsed message, or what is wrong with it. `id` is set as soon as a usable one
/// is found, so that an error can be answered to it.
std::variant<RpcRequest, RpcError> read_request(Json message, std::optional<Json>& id);

/// Texts of messages to a client. A null id answers what could not be read.
std::string write_reply(const Json& id, const RpcResult& result);
std::string write_event(std::string_view event, Json params);

}  // namespace vat
