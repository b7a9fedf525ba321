#include "protocol/client/connection/web_socket.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>

#include "protocol/client/connection/socket_stream.h"

namespace vat::client {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

/// Greatest number of received messages that wait for next(). Further ones remain in the socket.
constexpr std::size_t kMaxReceived = 256;

}  // namespace

/// Everything happens inside next() and connect(), on the caller's thread.
class WebSocket::Impl {
 public:
  Impl(const WebSocketUrl& url, const TlsTrust& trust)
      : url_(url), stream_(operations_.context(), url, trust) {}
  ~Impl() {
    try {
      stream_.next_layer().close_socket();
      operations_.run_out();  // ends the operations in flight, which refer to this
    } catch (...) {           // no caller can handle it
    }
  }

  /// The HTTP status.
  unsigned connect(const ConnectRequest& request, Deadline deadline);

  void send(Message message);
  void close() {
    closing_ = true;  // from here the library itself reads on, up to the answer
    stream_.async_close(websocket::close_code::normal, [this](error_code failure) {
      ended(failure ? failure : error_code(websocket::error::closed));
    });
  }
  void read(bool wanted) {
    read_wanted_ = wanted;
    start_read();
  }
  std::optional<Message> next(Deadline deadline) {
    start_read();
    operations_.run_until(deadline, [this] { return is_woken_ || !received_.empty(); });
    is_woken_ = false;
    if (received_.empty()) return {};
    Message message = std::move(received_.front());
    received_.pop_front();
    return message;
  }
  void wake() {
    asio::post(operations_.context(), [this] { is_woken_ = true; });
  }
  void cancel() {
    asio::post(operations_.context(), [this] {
      is_woken_ = true;
      if (!is_open_) stream_.next_layer().close_socket();
    });
  }

 private:
  unsigned upgrade(const ConnectRequest& request, Deadline deadline);
  void start_write();
  void start_read();
  void read_ended(error_code failure);
  void ended(error_code failure);

  WebSocketUrl url_;
  Operations operations_;
  websocket::stream<SocketStream, false> stream_;  // without compression
  beast::flat_buffer buffer_;
  std::deque<Message> to_send_;
  std::deque<Message> received_;
  bool writing_ = false;
  bool reading_ = false;
  bool read_wanted_ = true;
  bool closing_ = false;
  bool closed_ = false;
  bool is_open_ = false;
  bool is_woken_ = false;
};

unsigned WebSocket::Impl::upgrade(const ConnectRequest& request, Deadline deadline) {
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

unsigned WebSocket::Impl::connect(const ConnectRequest& request, Deadline deadline) {
  stream_.next_layer().open(deadline);
  const unsigned status = upgrade(request, deadline);
  if (status != 101) return status;
  stream_.read_message_max(std::size_t{64} << 20);
  is_open_ = true;
  start_read();
  return status;
}

void WebSocket::Impl::send(Message message) {
  to_send_.push_back(std::move(message));
  if (!writing_) start_write();
  operations_.run_ready();
}

void WebSocket::Impl::start_write() {
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

void WebSocket::Impl::start_read() {
  if (!is_open_ || reading_ || closed_ || !read_wanted_) return;
  if (received_.size() >= kMaxReceived) return;
  reading_ = true;
  stream_.async_read(buffer_, [this](error_code failure, std::size_t) { read_ended(failure); });
}

void WebSocket::Impl::read_ended(error_code failure) {
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

void WebSocket::Impl::ended(error_code failure) {
  closed_ = true;
  const std::uint16_t code = failure == websocket::error::closed ? stream_.reason().code : 0;
  const std::string reason(stream_.reason().reason.data(), stream_.reason().reason.size());
  received_.push_back({Message::Kind::closed, code == 0 ? failure.message() : reason, code});
}

WebSocket::WebSocket(const WebSocketUrl& url, const TlsTrust& trust)
    : impl_(std::make_unique<Impl>(url, trust)) {}

WebSocket::~WebSocket() = default;

unsigned WebSocket::connect(const ConnectRequest& request, Deadline deadline) {
  return impl_->connect(request, deadline);
}

void WebSocket::send_text(const std::string& text) {
  impl_->send({Message::Kind::text, text, 0});
}

void WebSocket::send_binary(const std::string& bytes) {
  impl_->send({Message::Kind::binary, bytes, 0});
}

void WebSocket::close() {
  impl_->close();
}

void WebSocket::read(bool wanted) {
  impl_->read(wanted);
}

std::optional<Message> WebSocket::next(Deadline deadline) {
  return impl_->next(deadline);
}

void WebSocket::wake() {
  impl_->wake();
}

void WebSocket::cancel() {
  impl_->cancel();
}

Connected connect_websocket(const WebSocketUrl& url, const TlsTrust& trust,
                            const ConnectRequest& request, Deadline deadline) {
  auto socket = std::make_unique<WebSocket>(url, trust);
  const unsigned status = socket->connect(request, deadline);
  if (status != 101) return {nullptr, status};
  return {std::move(socket), status};
}

}  // namespace vat::client
