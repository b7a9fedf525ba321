#include "server/script/client.h"

#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>

#include "server/script/socket_stream.h"

namespace vat::script {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

/// Everything happens inside next() and connect(), on the caller's thread.
class WebSocketClient final : public Client {
 public:
  WebSocketClient(const WebSocketUrl& url, const TlsTrust& trust)
      : url_(url), stream_(operations_.context(), url, trust) {}
  ~WebSocketClient() override {
    try {
      stream_.next_layer().close_socket();
      operations_.run_out();  // ends the operations in flight, which refer to this
    } catch (...) {           // no caller can handle it
    }
  }

  /// The HTTP status.
  unsigned connect(const ConnectRequest& request, Deadline deadline);

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
    operations_.run_until(deadline, [this] { return !received_.empty(); });
    if (received_.empty()) return {};
    Message message = std::move(received_.front());
    received_.pop_front();
    return message;
  }

 private:
  unsigned upgrade(const ConnectRequest& request, Deadline deadline);
  void send(Message message);
  void start_write();
  void start_read();
  void read_ended(error_code failure);
  void ended(error_code failure);

  WebSocketUrl url_;
  Operations operations_;
  websocket::stream<SocketStream, false> stream_;  // scripts offer no compression
  beast::flat_buffer buffer_;
  std::deque<Message> to_send_;
  std::deque<Message> received_;
  bool writing_ = false;
  bool reading_ = false;
  bool read_wanted_ = true;
  bool closing_ = false;
  bool closed_ = false;
};

unsigned WebSocketClient::upgrade(const ConnectRequest& request, Deadline deadline) {
  if (!request.subprotocol.empty()) {
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& upgrade) {
      upgrade.set(beast::http::field::sec_websocket_protocol, request.subprotocol);
    }));
  }
  websocket::response_type response;
  std::optional<error_code> outcome;
  stream_.async_handshake(response, url_.authority(),
                          request.path.empty() ? url_.path : request.path,
                          [&](error_code failure) { outcome = failure; });
  operations_.finish(stream_.next_layer(), outcome, deadline,
                     "the server did not answer the upgrade in time");
  if (*outcome && *outcome != websocket::error::upgrade_declined) {
    const std::string hint = url_.is_secure ? "" : "; a server with TLS is at wss://";
    throw std::runtime_error("the upgrade failed: " + outcome->message() + hint);
  }
  return response.result_int();
}

unsigned WebSocketClient::connect(const ConnectRequest& request, Deadline deadline) {
  stream_.next_layer().open(deadline);
  const unsigned status = upgrade(request, deadline);
  if (status != 101) return status;
  stream_.read_message_max(std::size_t{64} << 20);
  start_read();
  return status;
}

void WebSocketClient::send(Message message) {
  to_send_.push_back(std::move(message));
  if (!writing_) start_write();
  operations_.run_ready();
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

Connected connect_websocket(const WebSocketUrl& url, const TlsTrust& trust,
                            const ConnectRequest& request, Deadline deadline) {
  auto client = std::make_unique<WebSocketClient>(url, trust);
  const unsigned status = client->connect(request, deadline);
  if (status != 101) return {nullptr, status};
  return {std::move(client), status};
}

}  // namespace vat::script
