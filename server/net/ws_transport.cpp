#include "server/net/ws_transport.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/net/ws_connection.h"
#include "server/net/ws_upgrade.h"

namespace vat {

namespace {

using boost::asio::ip::tcp;
namespace opcode = websocketpp::frame::opcode;

constexpr std::chrono::seconds kStopTimeout{1};
constexpr std::chrono::seconds kResponseTimeout{60};  ///< for a peer to take a whole file
constexpr long kClosingHandshakeTimeout = 5000;       // [ms]
/// Sockets beyond the WebSockets: HTTP requests, upgrades under way, connections refused or ending.
constexpr std::size_t kMaxOtherSockets = 256;

constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kInternalError = 1011;
constexpr std::uint16_t kTryAgainLater = 1013;

[[noreturn]] void fail_to_listen(const TransportSettings& settings, const std::string& reason) {
  const bool is_v6 = settings.host.find(':') != std::string::npos;
  throw std::runtime_error("cannot listen on " +
                           (is_v6 ? "[" + settings.host + "]" : settings.host) + ":" +
                           std::to_string(settings.port) + ": " + reason);
}

/// The library keeps the reason to itself, so the same is tried without it.
std::string why_not_listen(boost::asio::io_context& io, const tcp::endpoint& endpoint) {
  boost::system::error_code error;
  tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  return error ? error.message() : "the port was in use a moment ago";
}

}  // namespace

WsTransport::WsTransport(TransportSettings settings, ConnectionHandler& connections,
                         HttpHandler http)
    : settings_(std::move(settings)),
      connections_(connections),
      http_(std::move(http)),
      io_(std::make_shared<boost::asio::io_context>(1)),
      ping_timer_(*io_),
      stop_timer_(*io_),
      socket_count_(std::make_shared<std::size_t>(0)) {
  configure();
  set_handlers();
}

WsTransport::~WsTransport() {
  stop();
}

void WsTransport::configure() {
  server_.init_asio(io_.get());
  server_.set_reuse_addr(true);
  server_.set_user_agent("");
  server_.set_max_message_size(settings_.max_message_bytes);
  server_.set_max_http_body_size(settings_.max_http_request_bytes);
  server_.set_open_handshake_timeout(static_cast<long>(settings_.handshake_timeout.count()));
  server_.set_close_handshake_timeout(kClosingHandshakeTimeout);
}

void WsTransport::set_handlers() {
  server_.set_tcp_pre_init_handler(
      [this](const Handle& handle) { guarded("accept", [&] { accepted(*stream_of(handle)); }); });
  server_.set_validate_handler([this](const Handle& handle) {
    bool granted = false;
    return guarded("upgrade", [&] { granted = validate(*stream_of(handle)); }) && granted;
  });
  server_.set_open_handler([this](const Handle& handle) {
    const StreamPtr opened_stream = stream_of(handle);
    if (guarded("open", [&] { opened(opened_stream); })) return;
    guarded("open", [&] { close_stream(*opened_stream, kInternalError, "internal error"); });
  });
  server_.set_message_handler([this](const Handle& handle, const WsMessage::ptr& message) {
    const StreamPtr sender = stream_of(handle);
    if (guarded("message", [&] { received(*sender, *message); })) return;
    guarded("message", [&] { close_stream(*sender, kInternalError, "internal error"); });
  });
  server_.set_ping_handler([this](const Handle& handle, const std::string& payload) {
    guarded("ping", [&] { answer_ping(*stream_of(handle), payload); });
    return false;
  });
  server_.set_pong_handler([this](const Handle& handle, const std::string&) {
    guarded("pong", [&] { stream_of(handle)->unanswered_pings = 0; });
  });
  server_.set_close_handler(
      [this](const Handle& handle) { guarded("close", [&] { closed(*stream_of(handle)); }); });
  server_.set_http_handler(
      [this](const Handle& handle) { guarded("http", [&] { answer_http(stream_of(handle)); }); });
}

std::uint16_t WsTransport::start() {
  listen();
  boost::system::error_code error;
  const std::uint16_t port = server_.get_local_endpoint(error).port();
  start_pings();
  thread_ = std::thread([this] { run(); });
  return port;
}

void WsTransport::listen() {
  boost::system::error_code address_error;
  const auto address = boost::asio::ip::make_address(settings_.host, address_error);
  if (address_error) fail_to_listen(settings_, "the host must be a numeric address");
  const tcp::endpoint endpoint(address, settings_.port);
  websocketpp::lib::error_code error;
  server_.listen(endpoint, error);
  if (error) fail_to_listen(settings_, why_not_listen(*io_, endpoint));
  server_.start_accept(error);
  if (error) fail_to_listen(settings_, error.message());
}

void WsTransport::run() {
  bool finished = false;
  while (!finished) finished = guarded("network", [this] { io_->run(); });
  forget_all();
}

/// Connections whose closing handshake did not end in time.
void WsTransport::forget_all() {
  for (const StreamPtr& left : open_streams()) {
    guarded("close", [&] { closed(*left); });
  }
}

void WsTransport::stop() {
  if (!thread_.joinable()) return;
  boost::asio::post(*io_, [this] {
    if (!guarded("stop", [this] { begin_stop(); })) io_->stop();
  });
  thread_.join();
}

void WsTransport::begin_stop() {
  stopping_ = true;
  ping_timer_.cancel();
  websocketpp::lib::error_code ignored;  // it is listening
  server_.stop_listening(ignored);
  const std::vector<StreamPtr> streams = open_streams();
  if (streams.empty()) return io_->stop();
  stop_timer_.expires_after(kStopTimeout);
  stop_timer_.async_wait([this](boost::system::error_code) { io_->stop(); });
  for (const StreamPtr& open : streams) close_stream(*open, kGoingAway, "the server is stopping");
}

/// Limits the sockets before they have said anything: the library would go on accepting until the
/// process is out of file descriptors.
void WsTransport::accepted(WsStream& stream) {
  ++*socket_count_;
  stream.socket_slot =
      std::shared_ptr<void>(nullptr, [count = socket_count_](std::nullptr_t) { --*count; });
  boost::system::error_code ignored;  // a socket that is closed already is found by the first read
  if (*socket_count_ > settings_.max_connections + kMaxOtherSockets) {
    stream.get_raw_socket().close(ignored);
  } else {
    stream.get_raw_socket().set_option(tcp::no_delay(true), ignored);
  }
}

bool WsTransport::validate(WsStream& stream) {
  const auto refusal = refuse_upgrade(
      {stream.get_request().get_uri(), stream.get_request_header("Host"),
       stream.get_request_header("Origin"), stream.get_request_header("Sec-WebSocket-Version"),
       stream.get_requested_subprotocols()});
  if (!refusal) {
    stream.select_subprotocol(kSubprotocol);
    return true;
  }
  stream.set_status(static_cast<websocketpp::http::status_code::value>(refusal->status));
  stream.append_header("Content-Type", "text/plain; charset=utf-8");
  stream.append_header("Connection", "close");
  stream.set_body(refusal->message);
  return false;
}

void WsTransport::opened(const StreamPtr& stream) {
  if (stopping_) return close_stream(*stream, kGoingAway, "the server is stopping");
  if (open_.size() >= settings_.max_connections) {
    return close_stream(*stream, kTryAgainLater, "too many connections");
  }
  stream->id = ++last_id_;
  stream->peer = std::make_shared<WsConnection>(stream->id, io_, stream);
  open_.emplace(stream->id, stream);
  connections_.opened(stream->peer);
}

void WsTransport::received(WsStream& stream, const WsMessage& message) {
  if (stream.id == 0) return;
  stream.unanswered_pings = 0;
  if (message.get_opcode() == opcode::TEXT) {
    connections_.text_received(stream.id, message.get_payload());
  } else {
    connections_.binary_received(stream.id, message.get_payload());
  }
}

/// Answers unless an earlier pong still waits for the socket, so that a peer that pings and never
/// reads makes nothing grow. RFC 6455, section 5.5.3 allows to skip pongs.
void WsTransport::answer_ping(WsStream& stream, const std::string& payload) {
  stream.unanswered_pings = 0;
  if (!stream.unsent_pong.expired()) return;
  const auto token = std::make_shared<char>();
  stream.unsent_pong = token;
  stream.send(std::make_shared<WsMessage>(opcode::PONG,
                                          std::make_shared<const std::string>(payload), token));
}

void WsTransport::closed(WsStream& stream) {
  if (stream.id == 0) return;
  const ConnectionId id = std::exchange(stream.id, 0);
  stream.peer->set_gone();
  // It shares the io_context, whose pending operations own the stream: a circle otherwise.
  stream.peer.reset();
  open_.erase(id);
  if (stopping_ && open_.empty()) io_->stop();
  connections_.closed(id);
}

void WsTransport::answer_http(const StreamPtr& stream) {
  // Deferring takes the response out of the handshake's time limit, which is too short for a large
  // file on a slow line.
  stream->defer_http_response();
  stream->response_deadline.emplace(*io_, kResponseTimeout);
  stream->response_deadline->async_wait(
      [handle = std::weak_ptr<WsStream>(stream)](boost::system::error_code error) {
        if (error) return;
        if (const auto slow = handle.lock()) {
          slow->terminate(make_error_code(websocketpp::transport::error::timeout));
        }
      });
  const HttpResponse response = ask_http_handler(*stream);
  stream->set_status(static_cast<websocketpp::http::status_code::value>(response.status));
  if (stream->get_request().get_method() != "HEAD") stream->set_body(response.body);
  for (const auto& [name, value] : response.headers) stream->replace_header(name, value);
  stream->replace_header("Content-Type", response.content_type);
  stream->replace_header("Content-Length", std::to_string(response.body.size()));
  stream->replace_header("Connection", "close");
  stream->send_http_response();
}

HttpResponse WsTransport::ask_http_handler(const WsStream& stream) {
  HttpResponse response;
  const auto& request = stream.get_request();
  const bool answered =
      guarded("http", [&] { response = http_(request.get_method(), request.get_uri()); });
  if (answered) return response;
  return {500, "text/plain; charset=utf-8", "Internal error.\n", {}};
}

void WsTransport::start_pings() {
  ping_timer_.expires_after(settings_.ping_interval);
  ping_timer_.async_wait([this](boost::system::error_code error) {
    if (error || stopping_) return;
    guarded("ping", [this] { ping_all(); });
    start_pings();
  });
}

void WsTransport::ping_all() {
  for (const StreamPtr& stream : open_streams()) {
    websocketpp::lib::error_code error;
    if (stream->unanswered_pings >= 2) {
      stream->terminate(make_error_code(websocketpp::transport::error::timeout));
    } else {
      ++stream->unanswered_pings;
      stream->ping("", error);  // fails on a connection that is closing, which has its own deadline
    }
  }
}

std::vector<WsTransport::StreamPtr> WsTransport::open_streams() const {
  std::vector<StreamPtr> streams;
  streams.reserve(open_.size());
  for (const auto& [id, handle] : open_) {
    if (StreamPtr stream = handle.lock()) streams.push_back(std::move(stream));
  }
  return streams;
}

WsTransport::StreamPtr WsTransport::stream_of(const Handle& handle) {
  return server_.get_con_from_hdl(handle);
}

template <class Work>
bool WsTransport::guarded(const char* place, Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& fault) {
    report(place, fault.what());
  } catch (...) {
    report(place, "unknown exception");
  }
  return false;
}

void WsTransport::report(const char* place, const char* fault) noexcept {
  if (!settings_.report) return;
  try {
    settings_.report(std::string(place) + ": " + fault);
  } catch (...) {  // nobody is left to tell
  }
}

std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http) {
  return std::make_unique<WsTransport>(std::move(settings), connections, std::move(http));
}

}  // namespace vat
