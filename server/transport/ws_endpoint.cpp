#include "server/transport/ws_endpoint.h"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/socket_base.hpp>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "server/transport/ws_connection.h"
#include "server/transport/ws_listen.h"

namespace vat {

namespace {

using boost::asio::ip::tcp;
namespace opcode = websocketpp::frame::opcode;

constexpr std::chrono::seconds kStopTimeout{1};
constexpr long kClosingHandshakeTimeout = 5000;  // [ms]

constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kNotUtf8 = 1007;
constexpr std::uint16_t kInternalError = 1011;
constexpr std::uint16_t kTryAgainLater = 1013;

/// Makes the library determine the byte order before other threads use it. The library does so at
/// its first conversion without synchronisation.
void find_byte_order() {
  [[maybe_unused]] static const std::uint64_t kFound = websocketpp::lib::net::_htonll(0);
}

bool ends_within_character(const std::string& text) {
  constexpr std::size_t kLongest = 4;
  for (std::size_t back = 1; back <= std::min(text.size(), kLongest); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if (byte >= 0xc0) return back < (byte >= 0xf0 ? 4U : byte >= 0xe0 ? 3U : 2U);
    if (byte < 0x80) return false;
  }
  return false;
}

/// Returns the address of the peer. Returns the unspecified address if the peer has disconnected.
boost::asio::ip::address address_of(const tcp::socket& socket) {
  boost::system::error_code error;
  const tcp::endpoint peer = socket.remote_endpoint(error);
  return error ? boost::asio::ip::address() : without_mapping(peer.address());
}

}  // namespace

WsEndpoint::WsEndpoint(WsShared& shared)
    : shared_(shared),
      tasks_(std::make_shared<WsTaskQueue>(io_)),
      ping_timer_(io_),
      stop_timer_(io_) {
  find_byte_order();
  configure();
  set_handlers();
}

WsEndpoint::~WsEndpoint() {
  tasks_->shut();
}

void WsEndpoint::configure() {
  server_.init_asio(&io_);
  server_.set_reuse_addr(true);
  server_.set_user_agent("");
  server_.set_max_message_size(shared_.settings.max_message_bytes);
  server_.set_max_http_body_size(shared_.settings.max_http_request_bytes);
  server_.set_open_handshake_timeout(static_cast<long>(shared_.settings.handshake_timeout.count()));
  server_.set_close_handshake_timeout(kClosingHandshakeTimeout);
  server_.set_tls(shared_.tls);
}

void WsEndpoint::set_handlers() {
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

void WsEndpoint::check_free(std::uint16_t port) {
  const std::string& host = shared_.settings.host;
  const auto error = try_to_listen(io_, listen_address(host, port));
  if (error) fail_to_listen(host, port, error.message());
}

std::uint16_t WsEndpoint::listen(std::uint16_t port, bool shares_port) {
  const std::string& host = shared_.settings.host;
  const tcp::endpoint endpoint = listen_address(host, port);
  if (shares_port) {
    server_.set_tcp_pre_bind_handler([](const auto& acceptor) { return share_port(*acceptor); });
  }
  websocketpp::lib::error_code error;
  server_.listen(endpoint, error);
  if (error) fail_to_listen(host, port, listen_failure(io_, endpoint));
  server_.start_accept(error);
  if (error) fail_to_listen(host, port, error.message());
  boost::system::error_code port_error;
  return server_.get_local_endpoint(port_error).port();
}

void WsEndpoint::start() {
  start_pings();
  thread_ = std::thread([this] { run(); });
}

void WsEndpoint::run() {
  pthread_setname_np(pthread_self(), "vat-network");
  bool finished = false;
  while (!finished) finished = guarded("network", [this] { io_.run(); });
  forget_all();
}

/// Closes connections whose closing handshake did not end in time.
void WsEndpoint::forget_all() {
  awaiting_response_.clear();
  for (const StreamPtr& left : open_streams()) {
    guarded("close", [&] { closed(*left); });
  }
}

void WsEndpoint::begin_stop() {
  boost::asio::post(io_, [this] {
    if (!guarded("stop", [this] { close_all(); })) io_.stop();
  });
}

void WsEndpoint::join() {
  thread_.join();
}

void WsEndpoint::close_all() {
  stopping_ = true;
  ping_timer_.cancel();
  websocketpp::lib::error_code ignored;  // the endpoint is listening
  server_.stop_listening(ignored);
  const std::vector<StreamPtr> streams = open_streams();
  if (streams.empty()) return io_.stop();
  stop_timer_.expires_after(kStopTimeout);
  stop_timer_.async_wait([this](boost::system::error_code) { io_.stop(); });
  for (const StreamPtr& open : streams) close_stream(*open, kGoingAway, "the server is stopping");
}

/// Limits the sockets before their first data. The library would accept connections until no file
/// descriptors are left. The sockets of a proxy belong to several clients, which are counted when
/// their requests arrive.
void WsEndpoint::accepted(WsStream& stream) {
  if (stream.socket_slot) return;  // the connection continues after a request
  const std::size_t count = ++*shared_.socket_count;
  stream.socket_slot = std::shared_ptr<void>(
      shared_.socket_count.get(), [counter = shared_.socket_count](void*) { --*counter; });
  boost::system::error_code ignored;  // the first read detects a closed socket
  stream.socket_address = address_of(stream.get_raw_socket());
  stream.address = address_for_limits(stream.socket_address);
  const char* passed = nullptr;
  if (count > shared_.settings.max_connections + kMaxOtherSockets) {
    passed = "connections";
  } else if (!shared_.proxies.trust(stream.socket_address) && !count_socket(stream)) {
    passed = "connections_per_address";
  }
  if (passed != nullptr) {
    stream.get_raw_socket().close(ignored);
    count_refusal(passed);
    return;
  }
  stream.get_raw_socket().set_option(tcp::no_delay(true), ignored);
  stream.get_raw_socket().set_option(
      boost::asio::socket_base::send_buffer_size(shared_.settings.send_buffer_bytes), ignored);
}

bool WsEndpoint::count_socket(WsStream& stream) {
  stream.address_slot = shared_.sockets_by_address.take(
      stream.address, shared_.settings.max_connections_per_address + kMaxOtherSocketsPerAddress);
  return stream.address_slot != nullptr;
}

void WsEndpoint::opened(const StreamPtr& stream) {
  if (stopping_) return close_stream(*stream, kGoingAway, "the server is stopping");
  stream->peer_slot =
      shared_.open_by_address.take(stream->address, shared_.settings.max_connections_per_address);
  if (!stream->peer_slot) {
    count_refusal("connections_per_address");
    return close_stream(*stream, kTryAgainLater, "too many connections from this address");
  }
  if (++shared_.open_count > shared_.settings.max_connections) {
    --shared_.open_count;
    stream->peer_slot.reset();
    count_refusal("connections");
    return close_stream(*stream, kTryAgainLater, "too many connections");
  }
  stream->id = ++shared_.last_id;
  stream->peer = std::make_shared<WsConnection>(stream->id, stream->address, tasks_, stream);
  open_.emplace(stream->id, stream);
  shared_.connections.opened(stream->peer);
}

void WsEndpoint::received(WsStream& stream, const WsMessage& message) {
  if (stream.id == 0) return;
  stream.unanswered_pings = 0;
  if (message.get_opcode() == opcode::TEXT) {
    // The library checks this only at the end of a message in one frame.
    if (ends_within_character(message.get_payload())) {
      return close_stream(stream, kNotUtf8, "text that is not UTF-8");
    }
    shared_.connections.text_received(stream.id, message.get_payload());
  } else {
    shared_.connections.binary_received(stream.id, message.get_payload());
  }
}

/// Answers a ping, unless an earlier pong still waits for the socket. A peer that sends pings and
/// does not read therefore uses no memory. RFC 6455, section 5.5.3 permits omitting pongs.
void WsEndpoint::answer_ping(WsStream& stream, const std::string& payload) {
  stream.unanswered_pings = 0;
  if (!stream.unsent_pong.expired()) return;
  const auto token = std::make_shared<char>();
  stream.unsent_pong = token;
  stream.send(std::make_shared<WsMessage>(opcode::PONG,
                                          std::make_shared<const std::string>(payload), token));
}

void WsEndpoint::closed(WsStream& stream) {
  if (stream.id == 0) return;
  const ConnectionId id = std::exchange(stream.id, 0);
  stream.peer_slot.reset();
  if (shared_.settings.count_close) shared_.settings.count_close(stream.get_local_close_code());
  stream.peer->set_gone();
  stream.peer.reset();
  open_.erase(id);
  --shared_.open_count;
  if (stopping_ && open_.empty()) io_.stop();
  shared_.connections.closed(id);
}

void WsEndpoint::count_refusal(std::string_view limit) const {
  if (shared_.settings.count_refusal) shared_.settings.count_refusal(limit);
}

void WsEndpoint::start_pings() {
  ping_timer_.expires_after(shared_.settings.ping_interval);
  ping_timer_.async_wait([this](boost::system::error_code error) {
    if (error || stopping_) return;
    guarded("ping", [this] { ping_all(); });
    start_pings();
  });
}

void WsEndpoint::ping_all() {
  for (const StreamPtr& stream : open_streams()) {
    websocketpp::lib::error_code error;
    if (stream->unanswered_pings >= 2) {
      stream->terminate(make_error_code(websocketpp::transport::error::timeout));
    } else {
      ++stream->unanswered_pings;
      stream->ping("", error);  // fails on a closing connection, which has a separate deadline
    }
  }
}

std::vector<WsEndpoint::StreamPtr> WsEndpoint::open_streams() const {
  std::vector<StreamPtr> streams;
  streams.reserve(open_.size());
  for (const auto& [id, handle] : open_) {
    if (StreamPtr stream = handle.lock()) streams.push_back(std::move(stream));
  }
  return streams;
}

WsEndpoint::StreamPtr WsEndpoint::stream_of(const Handle& handle) {
  return server_.get_con_from_hdl(handle);
}

void WsEndpoint::report(const char* place, const char* fault) noexcept {
  if (!shared_.settings.report) return;
  try {
    shared_.settings.report(std::string(place) + ": " + fault);
  } catch (...) {  // no caller can handle it
  }
}

}  // namespace vat
