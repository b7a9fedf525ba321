#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "protocol/client/connection/websocket_url.h"

namespace vat::client {

using Deadline = std::chrono::steady_clock::time_point;

struct Message {
  enum class Kind { text, binary, closed };
  Kind kind = Kind::text;
  std::string bytes;             ///< content of the message, or reason for closing
  std::uint16_t close_code = 0;  ///< 0: the connection failed without a close frame
};

/// WebSocket connection to a server.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual void send_text(const std::string& text) = 0;
  virtual void send_binary(const std::string& bytes) = 0;
  virtual void close() = 0;
  /// Enables or disables reading. While disabled, messages remain in the socket.
  virtual void read(bool wanted) = 0;
  /// Returns the next message, or nothing if no message arrives before the deadline. The last
  /// message has the kind `closed`.
  virtual std::optional<Message> next(Deadline deadline) = 0;
};

struct ConnectRequest {
  std::string path;                    ///< "": path of the URL
  std::string subprotocol = "vat.v1";  ///< "": no subprotocol is requested
};

/// Open connection, or HTTP status of the refusal.
struct Connected {
  std::unique_ptr<Connection> connection;
  unsigned http_status = 101;
};

/// Connects to a server. Throws UntrustedServer, or std::runtime_error if the connection fails.
Connected connect_websocket(const WebSocketUrl& url, const TlsTrust& trust,
                            const ConnectRequest& request, Deadline deadline);

}  // namespace vat::client
