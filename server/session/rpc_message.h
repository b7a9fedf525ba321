#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/json_reader.h"

/// JSON-RPC 2.0 messages and the errors of PROTOCOL.md.
namespace vat {

/// A reply's error. `data` is what stands beside its `kind`.
struct RpcError {
  int code = 0;
  std::string kind;
  std::string message;
  Json data = Json::object();
};

RpcError parse_failed(const Error& error);
RpcError invalid_request(std::string message);
RpcError method_not_found(std::string_view method);
/// There must be at least one error; paths are pointers into `params`.
RpcError invalid_params(const Errors& errors);
RpcError internal_error();
RpcError not_joined();
RpcError no_such_session(std::string_view session);
RpcError no_such_body(std::string message);
RpcError no_such_scene(std::string_view scene);
RpcError limit_reached(std::string_view limit, std::size_t maximum);
RpcError not_allowed(std::string message);
/// What the core refused: its no_such_body has an error of its own, all else is invalid_params.
RpcError refused(const Errors& errors);

using RpcResult = std::variant<Json, RpcError>;

struct RpcRequest {
  std::optional<Json> id;  ///< a string or an integer; absent: a notification
  std::string method;
  Json params;  ///< an object
};

/// The request in a parsed message, or what is wrong with it. `id` is set as soon as a usable one
/// is found, so that an error can be answered to it.
std::variant<RpcRequest, RpcError> read_request(Json message, std::optional<Json>& id);

/// Texts of messages to a client. A null id answers what could not be read.
std::string write_reply(const Json& id, const RpcResult& result);
std::string write_event(std::string_view event, Json params);

}  // namespace vat
