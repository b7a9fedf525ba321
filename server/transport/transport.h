#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Interface of the network. Hides the WebSocket library. Uses only C++17 and standard types, so
/// that the library's target can include it.
namespace vat {

/// Identifies a connection during the life of the server. Not reused.
using ConnectionId = std::uint64_t;

/// An open WebSocket. All functions may be called from any thread, and do nothing after the peer
/// has gone.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual ConnectionId id() const = 0;
  /// Address to which the per-address limits apply: the IPv4 address, or the /64 network of an IPv6
  /// address, because one host has many addresses in its network.
  virtual const std::string& address() const = 0;
  virtual void send_text(std::string message) = 0;
  /// The bytes are shared, not copied, until they are passed to the socket.
  virtual void send_binary(std::shared_ptr<const std::string> bytes) = 0;
  /// Bytes passed to send_* that the socket has not accepted yet.
  virtual std::size_t queued_bytes() const = 0;
  /// Sends a close frame with a code of PROTOCOL.md. Later sends do nothing.
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
};

/// Receives events of connections. The events of one connection arrive on one thread in order:
/// opened, messages, closed. Events of several connections may arrive simultaneously.
class ConnectionHandler {
 public:
  virtual ~ConnectionHandler() = default;
  virtual void opened(std::shared_ptr<Connection> connection) = 0;
  virtual void text_received(ConnectionId id, std::string_view message) = 0;
  virtual void binary_received(ConnectionId id, std::string_view message) = 0;
  virtual void closed(ConnectionId id) = 0;
};

/// A complete response. The transport adds Content-Length and Connection, and omits the body for
/// HEAD.
struct HttpResponse {
  int status = 200;
  std::string content_type;  ///< the header Content-Type
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< other headers: name, value
};

/// Answers an HTTP request. Called on the transport's threads, possibly several at once.
using HttpHandler = std::function<HttpResponse(std::string_view method, std::string_view target)>;

struct TransportSettings {
  std::string host = "127.0.0.1";  ///< a numeric address
  std::uint16_t port = 8080;       ///< 0: any free port
  /// PEM files. If both are set, the port uses only TLS (https and wss).
  std::string tls_certificate;
  std::string tls_key;
  /// Origins whose pages may connect, in addition to this server: "https://example.org".
  std::vector<std::string> allowed_origins;
  std::size_t endpoints = 1;                      ///< number of threads that share the port
  std::size_t max_connections = 1024;             ///< WebSockets; the next is closed with 1013
  std::size_t max_connections_per_address = 256;  ///< WebSockets of one address
  std::size_t max_message_bytes = 1024 * 1024;    ///< a longer one closes with 1009
  std::size_t max_http_request_bytes =
      16 * 1024;  ///< of the body; longer ones are answered with 413
  std::chrono::milliseconds handshake_timeout{10'000};  ///< for a complete request or upgrade
  /// Send buffer of the system per connection. The buffer is small, because queued frames become
  /// outdated and cannot be removed from it.
  int send_buffer_bytes = 128 * 1024;
  std::chrono::milliseconds ping_interval{
      20'000};  ///< a peer silent for two intervals is disconnected
  /// Called with faults of this program, such as an exception of a handler, on the transport's
  /// threads.
  std::function<void(std::string_view)> report;
  /// Called with the name of the exceeded limit, as in server.info's `limits`.
  std::function<void(std::string_view limit)> count_refusal;
  /// Called with the close code of an ended WebSocket; 1006 if it had none.
  std::function<void(std::uint16_t code)> count_close;
};

/// A port for HTTP and WebSocket, served from start() to stop() by one thread per endpoint. The
/// system assigns each connection to an endpoint permanently. Limits apply to all endpoints
/// together.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Starts to listen and serve. Returns the port. If this fails, throws std::runtime_error with a
  /// message that names host and port, or the TLS file.
  virtual std::uint16_t start() = 0;
  /// Stops listening, closes all connections with 1001, waits at most one second for the closing
  /// handshakes, and joins the threads.
  virtual void stop() = 0;
};

/// Creates a transport. The handlers must outlive it.
std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http);

}  // namespace vat
