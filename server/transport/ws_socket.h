#pragma once

#include <array>
#include <boost/asio.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <websocketpp/common/connection_hdl.hpp>
#include <websocketpp/transport/asio/base.hpp>
#include <websocketpp/transport/asio/security/base.hpp>
#include <websocketpp/transport/base/connection.hpp>
#include <websocketpp/uri.hpp>

#include "server/transport/tls_files.h"

namespace vat {

/// Socket with or without TLS, selected at run time. websocketpp is therefore compiled once for
/// both.
class WsByteStream {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using executor_type = Socket::executor_type;
  using Tls = boost::asio::ssl::stream<Socket&>;

  explicit WsByteStream(boost::asio::io_context& io) : socket_(io) {}

  /// Encrypts all later bytes.
  void start_tls(std::shared_ptr<TlsFiles::Context> context) {
    context_ = std::move(context);
    tls_.emplace(socket_, *context_);
  }

  executor_type get_executor() { return socket_.get_executor(); }
  Socket& socket() { return socket_; }
  Tls* tls() { return tls_ ? &*tls_ : nullptr; }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) {
      tls_->async_read_some(buffers, std::forward<Handler>(handler));
    } else {
      socket_.async_read_some(buffers, std::forward<Handler>(handler));
    }
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) {
      tls_->async_write_some(buffers, std::forward<Handler>(handler));
    } else {
      socket_.async_write_some(buffers, std::forward<Handler>(handler));
    }
  }

 private:
  Socket socket_;
  std::shared_ptr<TlsFiles::Context> context_;
  std::optional<Tls> tls_;
};

/// Socket policy of websocketpp. A shutdown first stops sending. It then reads and discards the
/// peer's data until the peer closes the connection. Closing with unread data would reset the
/// connection, and the peer could lose the close frame or the error page. Timers of websocketpp
/// limit the waiting times, including the TLS handshake.
class WsSocket : public std::enable_shared_from_this<WsSocket> {
 public:
  using type = WsSocket;
  using ptr = std::shared_ptr<WsSocket>;

  ptr get_shared() { return shared_from_this(); }
  bool is_secure() const { return tls_files_ != nullptr; }
  void set_tls(std::shared_ptr<const TlsFiles> files) { tls_files_ = std::move(files); }
  /// Sets a function that async_shutdown() calls first. The function may move the byte stream to
  /// another socket with take_stream(). The connection then remains open.
  void set_keep_handler(std::function<void()> keep) { keep_ = std::move(keep); }
  /// Takes the open byte stream of another socket, which must not be used afterwards.
  void take_stream(WsSocket& other) { stream_ = std::move(other.stream_); }

  WsByteStream& get_socket() { return *stream_; }
  WsByteStream::Socket& get_next_layer() { return stream_->socket(); }
  WsByteStream::Socket& get_raw_socket() { return stream_->socket(); }
  const WsByteStream::Socket& get_raw_socket() const { return stream_->socket(); }

  std::string get_remote_endpoint(websocketpp::lib::error_code& error) const {
    boost::system::error_code failure;
    const auto endpoint = stream_->socket().remote_endpoint(failure);
    if (failure) {
      error = websocketpp::transport::error::make_error_code(
          websocketpp::transport::error::pass_through);
      return failure.message();
    }
    std::ostringstream text;
    text << endpoint;
    return text.str();
  }

  template <class ErrorCode>
  static websocketpp::lib::error_code translate_ec(ErrorCode) {
    return websocketpp::transport::error::make_error_code(
        websocketpp::transport::error::pass_through);
  }

 protected:
  using Done = websocketpp::transport::asio::socket::shutdown_handler;
  using Ready = websocketpp::transport::init_handler;

  websocketpp::lib::error_code init_asio(boost::asio::io_service* io,
                                         const std::shared_ptr<boost::asio::io_service::strand>&,
                                         bool) {
    stream_ = std::make_unique<WsByteStream>(*io);
    return {};
  }
  void set_uri(const websocketpp::uri_ptr&) {}
  void set_handle(const websocketpp::connection_hdl&) {}
  void pre_init(const Ready& ready) { ready({}); }
  void post_init(Ready ready) {
    if (!tls_files_ || stream_->tls() != nullptr) return ready({});
    stream_->start_tls(tls_files_->context());
    stream_->tls()->async_handshake(
        boost::asio::ssl::stream_base::server,
        [self = get_shared(), ready = std::move(ready)](boost::system::error_code error) {
          ready(error ? translate_ec(error) : websocketpp::lib::error_code());
        });
  }
  boost::system::error_code cancel_socket() {
    boost::system::error_code error;
    get_raw_socket().cancel(error);
    return error;
  }
  websocketpp::lib::error_code get_ec() const { return {}; }

  void async_shutdown(Done done) {
    if (keep_) std::exchange(keep_, nullptr)();
    if (!stream_) return done({});
    WsByteStream::Tls* const tls = stream_->tls();
    if (tls == nullptr) return end_sending(std::move(done));
    // Fails if the peer still sends data or has disconnected. The next step does not depend on the
    // result.
    tls->async_shutdown([this, self = get_shared(),
                         done = std::move(done)](boost::system::error_code) { end_sending(done); });
  }

 private:
  void end_sending(Done done) {
    boost::system::error_code error;
    get_raw_socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
    if (error) return end(error, done);
    cancel_socket();  // otherwise the library's read could receive the end of the stream
    drain(std::move(done));
  }
  void drain(Done done) {
    get_raw_socket().async_read_some(
        boost::asio::buffer(discarded_), [this, self = get_shared(), done = std::move(done)](
                                             boost::system::error_code error, std::size_t) {
          if (!error) {
            drain(done);
          } else {
            end(error == boost::asio::error::eof ? boost::system::error_code() : error, done);
          }
        });
  }
  /// Closes the socket. The library may have started another read. The system reports the end of a
  /// stream to only one of two readers. Without the close, the other read would never complete and
  /// would keep the socket open.
  void end(boost::system::error_code error, const Done& done) {
    boost::system::error_code ignored;  // the connection has ended in either case
    get_raw_socket().close(ignored);
    done(error);
  }

  std::shared_ptr<const TlsFiles> tls_files_;  // null: no TLS
  std::unique_ptr<WsByteStream> stream_;
  std::function<void()> keep_;
  std::array<char, 4096> discarded_;
};

class WsSocketEndpoint {
 public:
  using type = WsSocketEndpoint;
  using socket_con_type = WsSocket;
  using socket_con_ptr = std::shared_ptr<WsSocket>;

  bool is_secure() const { return tls_files_ != nullptr; }
  /// Sets the TLS files of all later connections. Each connection uses the newest context.
  void set_tls(std::shared_ptr<const TlsFiles> files) { tls_files_ = std::move(files); }

 protected:
  websocketpp::lib::error_code init(const socket_con_ptr& connection) {
    connection->set_tls(tls_files_);
    return {};
  }

 private:
  std::shared_ptr<const TlsFiles> tls_files_;
};

}  // namespace vat
