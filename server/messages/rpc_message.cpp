#include "server/messages/rpc_message.h"

#include <utility>

#include "core/support/check.h"
#include "protocol/json/printable.h"

namespace vat {
namespace {

constexpr std::size_t kMaxIdBytes = 64;
constexpr double kRetryAfter = 1;  // [s], about the time until another node takes a session
constexpr std::size_t kMaxMethodBytes = 64;

bool is_id(const Json& value) {
  if (value.is_number_integer()) return true;
  return value.is_string() && value.get_ref<const std::string&>().size() <= kMaxIdBytes;
}

Json error_to_json(const Error& error) {
  Json json{{"code", error.code}, {"path", error.path}, {"message", error.message}};
  if (!error.suggestion.empty()) json["suggestion"] = error.suggestion;
  return json;
}

Json rpc_error_to_json(const RpcError& error) {
  const ErrorRow& row = error_row(error.kind);
  Json data = error.data;
  data["kind"] = row.name;
  data["hint"] = row.hint;
  return {{"code", row.code}, {"message", error.message}, {"data", std::move(data)}};
}

}  // namespace

std::string to_message_text(const Json& message) {
  // Foreign text is checked to be UTF-8 when it is received. Replacing is a second defence.
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

RpcError parse_failed(const Error& error) {
  return {ErrorKind::parse_error, error.message, {{"reason", error.code}}};
}

RpcError invalid_request(std::string message) {
  return {ErrorKind::invalid_request, std::move(message)};
}

RpcError with_suggestion(RpcError error, const std::string& name) {
  if (name.empty()) return error;
  error.message += "; did you mean " + name + "?";
  error.data["suggestion"] = name;
  return error;
}

RpcError method_not_found(std::string_view method) {
  return {ErrorKind::method_not_found, "there is no method " + printable(method)};
}

RpcError invalid_params(const Errors& errors) {
  VAT_CHECK(!errors.empty());
  Json list = Json::array();
  for (const Error& error : errors) list.push_back(error_to_json(error));
  const Error& first = errors.front();
  const std::string message =
      first.path.empty() ? first.message : first.path + ": " + first.message;
  return {ErrorKind::invalid_params, message, {{"path", first.path}, {"errors", std::move(list)}}};
}

RpcError internal_error() {
  return {ErrorKind::internal_error, "a fault of the server; see its log"};
}

RpcError name_in_use() {
  return invalid_params(
      {Error{"bad_value", "/name", "must differ from the names of the cluster's sessions"}});
}

RpcError not_joined() {
  return {ErrorKind::not_joined, "this method needs a joined session"};
}

RpcError no_such_session(std::string_view session, std::string_view path) {
  RpcError error{ErrorKind::no_such_session, "there is no session " + printable(session)};
  if (!path.empty()) error.data["path"] = path;
  return error;
}

RpcError no_such_body(std::string message, const std::string& path) {
  return {ErrorKind::no_such_body, std::move(message), {{"path", path}}};
}

RpcError no_such_scene(std::string_view scene, std::string_view path) {
  return {ErrorKind::no_such_scene, "there is no scene " + printable(scene), {{"path", path}}};
}

RpcError no_such_state(std::string_view name) {
  return invalid_params(
      {Error{"no_such_state", "/name", "no state of this session is saved as " + printable(name)}});
}

RpcError limit_reached(std::string_view limit, std::size_t maximum) {
  return {ErrorKind::limit_reached,
          "at most " + std::to_string(maximum) + " " + std::string(limit),
          {{"limit", limit}, {"maximum", maximum}}};
}

RpcError limit_reached(const LimitExcess& excess) {
  return limit_reached(excess.limit, excess.maximum);
}

RpcError not_allowed(std::string message) {
  return {ErrorKind::not_allowed, std::move(message)};
}

RpcError role_too_low(std::string_view method, Role role, Role least) {
  const std::string least_role = to_string(least);
  return {ErrorKind::not_allowed,
          std::string(method) + " needs the role " + least_role,
          {{"role", to_string(role)}, {"least_role", least_role}}};
}

RpcError not_authenticated(std::string message) {
  return {ErrorKind::not_authenticated, std::move(message)};
}

RpcError held_by_other(std::uint64_t participant, const std::string& name) {
  return {ErrorKind::busy,
          name + " holds this body",
          {{"path", "/body"}, {"holder", {{"participant", participant}, {"name", name}}}}};
}

RpcError storage_failed(StorageError::Kind reason) {
  const char* message = reason == StorageError::Kind::full      ? "the server's disk is full"
                        : reason == StorageError::Kind::corrupt ? "the saved data is damaged"
                        : reason == StorageError::Kind::unreachable
                            ? "the cluster cannot store commands now"
                            : "the server cannot write its data";
  RpcError error{ErrorKind::storage_failed, message};
  if (reason == StorageError::Kind::unreachable) error.data["retry_after"] = kRetryAfter;
  return error;
}

RpcError moved_to(std::string_view session, std::string_view url) {
  return {ErrorKind::moved,
          "the session " + printable(session) + " is at " + printable(url),
          {{"session", printable(session)}, {"url", url}}};
}

RpcError not_recovered(std::string_view session, std::string_view state) {
  return {ErrorKind::not_recovered,
          "the session " + printable(session) + " is " + std::string(state),
          {{"state", state}}};
}

RpcError rate_limited(std::string_view limit, double maximum, double retry_after) {
  const Json number(maximum);
  return {ErrorKind::rate_limited,
          "at most " + number.dump() + " " + std::string(limit),
          {{"limit", limit}, {"maximum", number}, {"retry_after", retry_after}}};
}

RpcError refused(const Errors& errors) {
  VAT_CHECK(!errors.empty());
  const Error& first = errors.front();
  if (first.code == "no_such_body") return no_such_body(first.message, first.path);
  return invalid_params(errors);
}

std::variant<RpcRequest, RpcError> read_request(Json message, std::optional<Json>& id) {
  if (message.is_array()) return invalid_request("batches are refused");
  if (!message.is_object()) return invalid_request("a request is an object");
  if (const auto found = message.find("id"); found != message.end()) {
    if (!is_id(*found)) {
      return invalid_request("\"id\" must be an integer or a string of at most 64 bytes");
    }
    id = *found;
  }
  if (const auto version = message.find("jsonrpc"); version == message.end() || *version != "2.0") {
    return invalid_request("\"jsonrpc\" must be \"2.0\"");
  }
  const auto method = message.find("method");
  if (method == message.end() || !method->is_string() ||
      method->get_ref<const std::string&>().size() > kMaxMethodBytes) {
    return invalid_request("\"method\" must be a string of at most 64 bytes");
  }
  for (const auto& [key, value] : message.items()) {
    if (key != "jsonrpc" && key != "id" && key != "method" && key != "params") {
      return invalid_request("unknown member " + printable(key));
    }
  }
  RpcRequest request{id, method->get<std::string>(), Json::object()};
  if (const auto params = message.find("params"); params != message.end()) {
    if (!params->is_object()) return invalid_request("\"params\" must be an object");
    request.params = std::move(*params);
  }
  return request;
}

std::string begin_reply(const Json& id) {
  return R"({"jsonrpc":"2.0","id":)" + to_message_text(id) + R"(,"result":)";
}

std::string begin_event(std::string_view event) {
  return R"({"jsonrpc":"2.0","method":)" + to_message_text(event) + R"(,"params":)";
}

std::string begin_object(const Json& object, std::string_view last_member) {
  std::string text = to_message_text(object);
  VAT_CHECK(object.is_object() && !object.empty());
  text.back() = ',';  // instead of the closing brace
  return text + to_message_text(last_member) + ':';
}

std::string write_reply(const Json& id, const RpcResult& result) {
  Json message{{"jsonrpc", "2.0"}, {"id", id}};
  if (const auto* error = std::get_if<RpcError>(&result)) {
    message["error"] = rpc_error_to_json(*error);
  } else {
    message["result"] = std::get<Json>(result);
  }
  return to_message_text(message);
}

std::string write_event(std::string_view event, Json params) {
  return to_message_text({{"jsonrpc", "2.0"}, {"method", event}, {"params", std::move(params)}});
}

}  // namespace vat
