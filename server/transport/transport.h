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

/// Network interface, independent of the WebSocket library. Uses only C++17 and standard types, so
/// that the library's target can include this header.
namespace vat {

/// Identifier of a connection. An id is not used twice during a run of the server.
using ConnectionId = std::uint64_t;

/// An open WebSocket. Thread-safe. After the peer has disconnected, all functions have no effect.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual ConnectionId id() const = 0;
  /// Returns the address for the per-address limits. For IPv4, returns the complete address. For
  /// IPv6, returns the /64 network, because one host can use many addresses in its network.
  virtual const std::string& address() const = 0;
  /// Sends a text message, which is `head` followed by `tail`. Null: there is no tail. The tail is
  /// shared and not copied before the socket accepts it.
  virtual void send_text(std::string head, std::shared_ptr<const std::string> tail = nullptr) = 0;
  /// Sends bytes. The bytes are shared and not copied before the socket accepts them.
  virtual void send_binary(std::shared_ptr<const std::string> bytes) = 0;
  /// Returns the number of sent bytes that the socket has not accepted yet.
  virtual std::size_t queued_bytes() const = 0;
  /// Sends a close frame with a code of PROTOCOL.md. Later sends have no effect.
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
};

/// Receiver of the events of connections. The events of one connection arrive on one thread, in the
/// order opened, messages, closed. Events of several connections can arrive simultaneously.
class ConnectionHandler {
 public:
  virtual ~ConnectionHandler() = default;
  virtual void opened(std::shared_ptr<Connection> connection) = 0;
  virtual void text_received(ConnectionId id, std::string_view message) = 0;
  virtual void binary_received(ConnectionId id, std::string_view message) = 0;
  virtual void closed(ConnectionId id) = 0;
};

/// HTTP request. Absent headers are empty.
struct HttpRequest {
  std::string_view method;
  std::string_view target;
  std::string_view accept_encoding = {};
  std::string_view if_none_match = {};
  std::string_view authorization = {};
};

/// Complete HTTP response. The transport adds Content-Length and Connection, and omits the body for
/// HEAD. A response 204 or 304 must have no body.
struct HttpResponse {
  int status = 200;
  std::string content_type;  ///< header Content-Type
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< other headers: name, value
  /// If set, the response follows, and the other members have no effect. The transport calls the
  /// function once, with a function for the response that any thread may call once.
  std::function<void(std::function<void(HttpResponse)>)> later{};
};

/// Function that returns the response to an HTTP request. Several transport threads may call the
/// function simultaneously.
using HttpHandler = std::function<HttpResponse(const HttpRequest& request)>;

struct TransportSettings {
  std::string host = "127.0.0.1";  ///< numeric address
  std::uint16_t port = 8080;       ///< 0: any free port
  /// PEM files. If both are set, the port uses only TLS (https and wss).
  std::string tls_certificate;
  std::string tls_key;
  /// Origins whose pages may connect, in addition to this server. Example: "https://example.org".
  std::vector<std::string> allowed_origins;
  /// Names in the Host header, in addition to localhost and numeric addresses. Without a port, a
  /// name is valid with all ports. Examples: "example.org", "example.org:8443".
  std::vector<std::string> public_names;
  /// Addresses or networks of proxies that name their client in a header, see TrustedProxies.
  std::vector<std::string> trusted_proxies;
  std::size_t endpoints = 1;                      ///< number of threads that share the port
  std::size_t max_connections = 1024;             ///< WebSockets; further ones are closed with 1013
  std::size_t max_connections_per_address = 256;  ///< WebSockets of one address
  std::size_t max_message_bytes = 1024 * 1024;  ///< longer messages close the connection with 1009
  /// Limit of the request body. A longer body is answered with 413.
  std::size_t max_http_request_bytes = 16 * 1024;
  std::chrono::milliseconds handshake_timeout{10'000};  ///< for a complete request or upgrade
  /// Size of the system's send buffer per connection. The buffer is small, because frames in the
  /// buffer become outdated and cannot be removed.
  int send_buffer_bytes = 128 * 1024;
  /// Interval of pings. A peer that sends nothing for two intervals is disconnected.
  std::chrono::milliseconds ping_interval{20'000};
  /// Callback for faults of this program, such as an exception in a handler. Called on the
  /// transport's threads.
  std::function<void(std::string_view)> report;
  /// Callback with the name of an exceeded limit in server.info's `limits`.
  std::function<void(std::string_view limit)> count_refusal;
  /// Callback with the close code of a closed WebSocket. The code is 1006 if there was no close
  /// frame.
  std::function<void(std::uint16_t code)> count_close;
};

/// Port for HTTP and WebSocket. From start() to stop(), one thread per endpoint serves the port.
/// The system assigns each connection permanently to an endpoint. Limits apply to all endpoints
/// together.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Starts to listen and to serve. Returns the port. Throws std::runtime_error on failure, with a
  /// message that names host and port or the TLS file.
  virtual std::uint16_t start() = 0;
  /// Stops listening and closes all connections with 1001. Waits at most one second for the closing
  /// handshakes, and joins the threads.
  virtual void stop() = 0;
  /// Reads the TLS files again. Connections that are open continue with the previous certificate.
  /// Throws std::runtime_error that names the invalid file. The previous certificate then remains
  /// in use. Has no effect without TLS.
  virtual void read_certificate() = 0;
};

/// Returns a transport. The handlers must outlive the transport.
std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http);

}  // namespace vat
