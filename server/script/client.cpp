#include "server/script/client.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>

namespace vat::script {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

/// Everything happens inside next() and connect(), on the caller's thread.
class WebSocketClient final : public Client {
 public:
  WebSocketClient() : stream_(context_) {}
  ~WebSocketClient() override {
    error_code ignored;  // the peer may have gone
    beast::get_lowest_layer(stream_).socket().close(ignored);
    context_.restart();
    context_.run();  // ends the operations in flight, which refer to this
  }

  /// The HTTP status.
  unsigned connect(const WebSocketUrl& url, const ConnectRequest& request, Deadline deadline);

  void send_text(const std::string& text) override { send({Message::Kind::text, text, 0}); }
  void send_binary(const std::string& bytes) override { send({Message::Kind::binary, bytes, 0}); }
  void close() override {
    closing_ = true;  // from here the library itself reads on, up to the answer
    stream_.async_close(websocket::close_code::normal, [this](error_code failure) {
      ended(failure ? failure : error_code(websocket::error::closed));
    });
  }
  void read(bool wanted) override {
    read_wanted_ = wanted;
    start_read();
  }
  std::optional<Message> next(Deadline deadline) override {
    run_until(deadline, [this] { return !received_.empty(); });
    if (received_.empty()) return {};
    Message message = std::move(received_.front());
    received_.pop_front();
    return message;
  }

 private:
  void open_socket(const WebSocketUrl& url, Deadline deadline);
  template <class Condition>
  void run_until(Deadline deadline, Condition&& reached);
  void send(Message message);
  void start_write();
  void start_read();
  void read_ended(error_code failure);
  void ended(error_code failure);

  asio::io_context context_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::deque<Message> to_send_;
  std::deque<Message> received_;
  bool writing_ = false;
  bool reading_ = false;
  bool read_wanted_ = true;
  bool closing_ = false;
  bool closed_ = false;
};

template <class Condition>
void WebSocketClient::run_until(Deadline deadline, Condition&& reached) {
  context_.restart();
  context_.poll();
  while (!reached() && std::chrono::steady_clock::now() < deadline) {
    context_.restart();
    if (context_.run_one_until(deadline) == 0 && context_.stopped()) return;  // nothing to wait for
  }
}

void WebSocketClient::open_socket(const WebSocketUrl& url, Deadline deadline) {
  asio::ip::tcp::resolver resolver(context_);
  error_code failure;
  const auto found = resolver.resolve(url.host, url.port, failure);
  if (failure) throw std::runtime_error("no address of " + url.host + ": " + failure.message());
  beast::tcp_stream& socket = beast::get_lowest_layer(stream_);
  std::optional<error_code> outcome;
  socket.expires_at(deadline);
  socket.async_connect(found, [&](error_code result, const auto&) { outcome = result; });
  run_until(Deadline::max(), [&] { return outcome.has_value(); });
  socket.expires_never();
  if (*outcome) {
    throw std::runtime_error("no server at " + url.authority() + ": " + outcome->message());
  }
}

unsigned WebSocketClient::connect(const WebSocketUrl& url, const ConnectRequest& request,
                                  Deadline deadline) {
  open_socket(url, deadline);
  if (!request.subprotocol.empty()) {
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& upgrade) {
      upgrade.set(beast::http::field::sec_websocket_protocol, request.subprotocol);
    }));
  }
  websocket::response_type response;
  std::optional<error_code> outcome;
  stream_.async_handshake(response, url.authority(), request.path.empty() ? url.path : request.path,
                          [&](error_code failure) { outcome = failure; });
  run_until(deadline, [&] { return outcome.has_value(); });
  if (!outcome) {
    beast::get_lowest_layer(stream_).socket().close();
    run_until(Deadline::max(), [&] { return outcome.has_value(); });
    throw std::runtime_error("the server did not answer the upgrade in time");
  }
  if (*outcome == websocket::error::upgrade_declined) return response.result_int();
  if (*outcome) throw std::runtime_error("the upgrade failed: " + outcome->message());
  stream_.read_message_max(std::size_t{64} << 20);
  start_read();
  return response.result_int();
}

void WebSocketClient::send(Message message) {
  to_send_.push_back(std::move(message));
  if (!writing_) start_write();
  context_.restart();
  context_.poll();
}

void WebSocketClient::start_write() {
  writing_ = true;
  const Message& message = to_send_.front();
  stream_.binary(message.kind == Message::Kind::binary);
  stream_.async_write(asio::buffer(message.bytes), [this](error_code failure, std::size_t) {
    writing_ = false;
    to_send_.pop_front();
    if (failure) {
      to_send_.clear();  // the read tells that the connection has ended
    } else if (!to_send_.empty()) {
      start_write();
    }
  });
}

void WebSocketClient::start_read() {
  if (reading_ || closed_ || !read_wanted_) return;
  reading_ = true;
  stream_.async_read(buffer_, [this](error_code failure, std::size_t) { read_ended(failure); });
}

void WebSocketClient::read_ended(error_code failure) {
  reading_ = false;
  if (failure) {
    if (!closing_) ended(failure);
    return;
  }
  received_.push_back({stream_.got_binary() ? Message::Kind::binary : Message::Kind::text,
                       beast::buffers_to_string(buffer_.data()), 0});
  buffer_.consume(buffer_.size());
  start_read();
}

void WebSocketClient::ended(error_code failure) {
  closed_ = true;
  const std::uint16_t code = failure == websocket::error::closed ? stream_.reason().code : 0;
  const std::string reason(stream_.reason().reason.data(), stream_.reason().reason.size());
  received_.push_back({Message::Kind::closed, code == 0 ? failure.message() : reason, code});
}

}  // namespace

Connected connect_websocket(const WebSocketUrl& url, const ConnectRequest& request,
                            Deadline deadline) {
  auto client = std::make_unique<WebSocketClient>();
  const unsigned status = client->connect(url, request, deadline);
  if (status != 101) return {nullptr, status};
  return {std::move(client), status};
}

}  // namespace vat::script
