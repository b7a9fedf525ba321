#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/stream_traits.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "protocol/client/connection/websocket_url.h"

namespace vat::client {

/// TCP connection, with TLS if the URL of the server requires TLS. HTTP and WebSocket of
/// Boost.Beast use the connection. All handlers have one type, so that the templates of Boost.Beast
/// are compiled once. Not thread-safe: operations run only inside the member functions of
/// Operations.
class SocketStream {
 public:
  // NOLINTNEXTLINE(readability-identifier-naming): the name that Boost.Asio requires
  using executor_type = boost::asio::io_context::executor_type;
  using ErrorCode = boost::system::error_code;
  using Handler = std::function<void(ErrorCode, std::size_t)>;
  using Deadline = std::chrono::steady_clock::time_point;

  /// Throws std::runtime_error if the certificates of `trust` cannot be read.
  SocketStream(boost::asio::io_context& context, const WebSocketUrl& url, const TlsTrust& trust);
  ~SocketStream();
  SocketStream(const SocketStream&) = delete;
  SocketStream& operator=(const SocketStream&) = delete;

  executor_type get_executor();
  /// Connects and checks the server's certificate. Throws UntrustedServer, or std::runtime_error
  /// with the cause.
  void open(Deadline deadline);
  /// Closes the socket. Operations in progress end with an error.
  void close_socket();

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(
        [this, &buffers](auto handler) {
          start_read(first_buffer<boost::asio::mutable_buffer>(buffers), share(std::move(handler)));
        },
        token);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(
        [this, &buffers](auto handler) {
          start_write(first_buffer<boost::asio::const_buffer>(buffers), share(std::move(handler)));
        },
        token);
  }
  /// Closes the transport after the closing handshake of the WebSocket.
  void start_teardown(std::function<void(ErrorCode)> handler);

 private:
  struct Transport;

  /// Returns the first non-empty buffer. One buffer is sufficient, because partial reads and writes
  /// are allowed.
  template <class Buffer, class Buffers>
  static Buffer first_buffer(const Buffers& buffers) {
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto it = boost::asio::buffer_sequence_begin(buffers); it != end; ++it) {
      if (Buffer(*it).size() > 0) return *it;
    }
    return {};
  }
  /// Returns a copyable handler, as Handler requires. The handlers of Boost.Beast can only be
  /// moved.
  template <class Moved>
  static Handler share(Moved handler) {
    return [shared = std::make_shared<Moved>(std::move(handler))](
               ErrorCode failure, std::size_t bytes) { std::move (*shared)(failure, bytes); };
  }

  void start_read(boost::asio::mutable_buffer buffer, Handler handler);
  void start_write(boost::asio::const_buffer buffer, Handler handler);

  boost::asio::io_context& context_;
  WebSocketUrl url_;
  std::unique_ptr<Transport> transport_;
};

/// Closes a stream. Boost.Beast finds the function by argument-dependent lookup.
template <class Handler>
void async_teardown(boost::beast::role_type, SocketStream& stream, Handler&& handler) {
  auto shared = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
  stream.start_teardown(
      [shared](SocketStream::ErrorCode failure) { std::move (*shared)(failure); });
}
inline void beast_close_socket(SocketStream& stream) {
  stream.close_socket();
}

/// Executor of the operations of one stream on the caller's thread.
class Operations {
 public:
  using Deadline = SocketStream::Deadline;

  boost::asio::io_context& context() { return context_; }

  /// Runs handlers until the operation has set `outcome`. At the deadline, closes the stream and
  /// throws std::runtime_error with the message `fault`.
  void finish(SocketStream& stream, const std::optional<SocketStream::ErrorCode>& outcome,
              Deadline deadline, const char* fault);
  /// Runs handlers until `reached` returns true, until the deadline, or until no operations remain.
  void run_until(Deadline deadline, const std::function<bool()>& reached);
  /// Runs all handlers that are ready.
  void run_ready();
  /// Runs handlers until all operations have ended.
  void run_out();

 private:
  boost::asio::io_context context_;
};

}  // namespace vat::client
