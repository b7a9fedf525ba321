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

/// The network as the rest of the server sees it; the WebSocket library stays behind it. C++17 and
/// standard types only, so that the library's own target can include it.
namespace vat {

/// Names a connection for the life of the server; never used twice.
using ConnectionId = std::uint64_t;

/// One open WebSocket. Every member may be called from any thread and after the peer has gone, when
/// it does nothing.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual ConnectionId id() const = 0;
  /// Of the peer, as its connections and sessions are counted: the host, or of IPv6 the network of
  /// 64 bits, of which one host has many.
  virtual const std::string& address() const = 0;
  virtual void send_text(std::string message) = 0;
  /// The bytes are shared, not copied, until they are handed to the socket.
  virtual void send_binary(std::shared_ptr<const std::string> bytes) = 0;
  /// Bytes handed to send_* that the socket has not taken yet.
  virtual std::size_t queued_bytes() const = 0;
  /// Sends a close frame with a code of PROTOCOL.md; later sends do nothing.
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
};

/// Told of what comes in: of one connection always on the same thread of the transport, and in
/// order: opened, then messages, then closed. Of several connections at once where there are
/// several endpoints.
class ConnectionHandler {
 public:
  virtual ~ConnectionHandler() = default;
  virtual void opened(std::shared_ptr<Connection> connection) = 0;
  virtual void text_received(ConnectionId id, std::string_view message) = 0;
  virtual void binary_received(ConnectionId id, std::string_view message) = 0;
  virtual void closed(ConnectionId id) = 0;
};

/// A complete response. The transport adds Content-Length and Connection, and leaves out the body
/// where the method is HEAD.
struct HttpResponse {
  int status = 200;
  std::string content_type;  ///< the header Content-Type
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< further ones: name, value
};

/// Answers a plain HTTP request; called on the transport's threads, several at once.
using HttpHandler = std::function<HttpResponse(std::string_view method, std::string_view target)>;

struct TransportSettings {
  std::string host = "127.0.0.1";  ///< a numeric address
  std::uint16_t port = 8080;       ///< 0: any free port
  /// Files in PEM: with both, the port speaks TLS (https and wss) and nothing else.
  std::string tls_certificate;
  std::string tls_key;
  /// Pages of these origins may connect, beside those of this server: "https://example.org".
  std::vector<std::string> allowed_origins;
  std::size_t endpoints = 1;                       ///< threads that share the port's connections
  std::size_t max_connections = 1024;              ///< WebSockets; the next is closed with 1013
  std::size_t max_connections_per_address = 256;   ///< the same
  std::size_t max_message_bytes = 1024 * 1024;     ///< a longer one closes with 1009
  std::size_t max_http_request_bytes = 16 * 1024;  ///< of the body; a longer one gets 413
  std::chrono::milliseconds handshake_timeout{10'000};  ///< for a whole request or upgrade
  /// Of the system for each connection. Small: what lies in it is late and cannot be taken back.
  int send_buffer_bytes = 128 * 1024;
  std::chrono::milliseconds ping_interval{20'000};  ///< a peer silent for two of them is dropped
  /// Told of faults of this program (a handler that throws); called on the transport's threads.
  std::function<void(std::string_view)> report;
  /// Told of each connection that a limit refuses, by its name in server.info's `limits`.
  std::function<void(std::string_view limit)> count_refusal;
  /// Told of each WebSocket that has ended, with its close code; 1006 where there was none.
  std::function<void(std::uint16_t code)> count_close;
};

/// One port for HTTP and WebSocket, served from start() to stop() by as many threads of its own as
/// there are endpoints. The system spreads the connections over them; each stays where it came.
/// Limits hold for all endpoints together.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Begins to listen and serve. Throws std::runtime_error that names host and port, or the file
  /// for TLS, if it cannot.
  /// Returns the port that is listened on.
  virtual std::uint16_t start() = 0;
  /// Stops listening, closes every connection with 1001, waits for the closing handshakes at most
  /// one second, and joins the threads.
  virtual void stop() = 0;
};

/// The handlers must outlive the transport.
std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http);

}  // namespace vat
