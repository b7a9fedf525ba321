#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/support/header_text.h"
#include "server/transport/host_names.h"
#include "server/transport/ws_endpoint.h"
#include "server/transport/ws_upgrade.h"

namespace vat {

namespace {

constexpr std::chrono::seconds kResponseTimeout{60};  ///< until a peer has received a whole file
/// Sockets besides the WebSockets, above which connections are closed after a response.
constexpr std::size_t kMaxKeptSockets = 128;
constexpr const char* kPlainText = "text/plain; charset=utf-8";

constexpr HttpRefusal kForeignHost{
    421,
    "The Host header does not name this server. Start the server with --public-name NAME to allow "
    "a name.\n"};
constexpr HttpRefusal kTooManySockets{429, "There are too many connections from this address.\n"};

void set_status(WsStream& stream, int status) {
  namespace code = websocketpp::http::status_code;
  constexpr int kMisdirectedRequest = 421;  // the library does not know it
  const auto value = static_cast<code::value>(status);
  stream.set_status(
      value, status == kMisdirectedRequest ? "Misdirected Request" : code::get_string(value));
}

/// Returns whether a list with commas contains the word.
bool has_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (equal_ignoring_case(take_part(list, ','), word)) return true;
  }
  return false;
}

/// A response 204 or 304 has no header about its content.
bool has_content(const HttpResponse& response) {
  return response.status != 204 && response.status != 304;
}

}  // namespace

/// Returns the reason for the refusal of a request or upgrade, or nothing. Sets the address of the
/// client if the socket belongs to a trusted proxy.
std::optional<HttpRefusal> WsEndpoint::refuse_request(WsStream& stream) {
  const HostKind host =
      kind_of_host(stream.get_request_header("Host"), shared_.settings.public_names);
  if (host == HostKind::foreign) return kForeignHost;
  if (!shared_.proxies.trust(stream.socket_address)) return std::nullopt;
  stream.address = address_for_limits(
      shared_.proxies.client_of(stream.socket_address, stream.get_request_header("Forwarded"),
                                stream.get_request_header("X-Forwarded-For")));
  if (count_socket(stream)) return std::nullopt;
  count_refusal("connections_per_address");
  return kTooManySockets;
}

bool WsEndpoint::validate(WsStream& stream) {
  std::optional<HttpRefusal> refusal = refuse_request(stream);
  if (!refusal) {
    refusal =
        refuse_upgrade({stream.get_request().get_uri(), stream.get_request_header("Host"),
                        stream.get_request_header("Origin"), stream.get_request().websocket_version,
                        stream.get_requested_subprotocols()},
                       shared_.settings.allowed_origins);
  }
  if (!refusal) {
    stream.select_subprotocol(kSubprotocol);
    return true;
  }
  set_status(stream, refusal->status);
  stream.append_header("Content-Type", kPlainText);
  stream.append_header("Connection", "close");
  stream.replace_header("Sec-WebSocket-Version", kWebSocketVersion);  // RFC 6455, section 4.4
  stream.set_body(refusal->message);
  return false;
}

void WsEndpoint::answer_http(const StreamPtr& stream) {
  // A deferred response is exempt from the handshake's time limit, which is too short for a large
  // file on a slow connection.
  stream->defer_http_response();
  stream->response_deadline.emplace(io_, kResponseTimeout);
  stream->response_deadline->async_wait(
      [this, handle = std::weak_ptr<WsStream>(stream)](boost::system::error_code error) {
        if (error) return;
        if (const auto slow = handle.lock()) {
          awaiting_response_.erase(slow);
          slow->terminate(make_error_code(websocketpp::transport::error::timeout));
        }
      });
  const std::optional<HttpRefusal> refusal = refuse_request(*stream);
  const HttpResponse response =
      refusal ? HttpResponse{refusal->status, kPlainText, refusal->message, {}}
              : ask_http_handler(*stream);
  if (response.later) return answer_later(stream, response);
  send_response(stream, response);
}

/// Sends a response that follows, unless the peer or the endpoint has ended before.
void WsEndpoint::answer_later(const StreamPtr& stream, const HttpResponse& response) {
  awaiting_response_.insert(stream);
  const auto send = [this](const StreamPtr& answered, const HttpResponse& follows) {
    if (awaiting_response_.erase(answered) == 0) return;  // the deadline has passed
    guarded("http", [&] { send_response(answered, follows); });
  };
  response.later([send, tasks = tasks_, handle = std::weak_ptr<WsStream>(stream)](
                     HttpResponse follows) {  // the queue drops the task after the endpoint's end
    tasks->run(handle, [send, follows = std::move(follows)](const StreamPtr& answered) {
      send(answered, follows);
    });
  });
}

void WsEndpoint::send_response(const StreamPtr& stream, const HttpResponse& response) {
  set_status(*stream, response.status);
  if (stream->get_request().get_method() != "HEAD") stream->set_body(response.body);
  for (const auto& [name, value] : response.headers) stream->replace_header(name, value);
  add_strict_transport(*stream);
  if (has_content(response)) {
    stream->replace_header("Content-Type", response.content_type);
    stream->replace_header("Content-Length", std::to_string(response.body.size()));
  }
  if (may_keep(*stream)) {
    stream->set_keep_handler([this, handle = std::weak_ptr<WsStream>(stream)] {
      if (const StreamPtr answered = handle.lock()) {
        guarded("http", [&] { continue_with_next(*answered); });
      }
    });
  } else {
    stream->replace_header("Connection", "close");
  }
  stream->send_http_response();
}

/// Makes browsers use only TLS for a public name. The header applies to all ports of the name, so
/// that localhost is exempt.
void WsEndpoint::add_strict_transport(WsStream& stream) const {
  const HostKind host =
      kind_of_host(stream.get_request_header("Host"), shared_.settings.public_names);
  if (!shared_.tls || host != HostKind::public_name) return;
  stream.replace_header("Strict-Transport-Security", "max-age=31536000");
}

/// Returns whether a further request can follow on the connection. The library discards the bytes
/// after a request, and does not determine the end of every body correctly.
bool WsEndpoint::may_keep(const WsStream& stream) const {
  const WsRequest& request = stream.get_request();
  const std::size_t other_sockets = *shared_.socket_count - shared_.open_count;
  const bool may_have_body = !request.get_header("Content-Length").empty() ||
                             !request.get_header("Transfer-Encoding").empty();
  return request.get_version() == "HTTP/1.1" && request.rest == 0 && !may_have_body &&
         !has_word(request.get_header("Connection"), "close") && other_sockets <= kMaxKeptSockets;
}

/// Moves the socket of an answered request to a new stream, because a stream of the library serves
/// only one request. The time limit of a handshake applies to the next request. Has no effect if
/// the response was not sent.
void WsEndpoint::continue_with_next(WsStream& answered) {
  const bool is_sent =
      answered.get_ec() == make_error_code(websocketpp::error::http_connection_ended);
  if (!is_sent || stopping_) return;
  const StreamPtr next = server_.get_connection();
  if (!next) return;
  next->take_stream(answered);
  next->socket_slot = std::move(answered.socket_slot);
  next->socket_address = answered.socket_address;
  next->address = answered.address;
  if (!shared_.proxies.trust(next->socket_address)) {
    next->address_slot = std::move(answered.address_slot);
  }
  next->start();
}

HttpResponse WsEndpoint::ask_http_handler(const WsStream& stream) {
  HttpResponse response;
  const auto& request = stream.get_request();
  const bool answered = guarded("http", [&] {
    response = shared_.http(
        {request.get_method(), request.get_uri(), request.get_header("Accept-Encoding"),
         request.get_header("If-None-Match"), request.get_header("Authorization")});
  });
  if (answered) return response;
  return {500, kPlainText, "Internal error.\n", {}};
}

}  // namespace vat
