#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/script/pattern.h"
#include "server/script/websocket_url.h"

namespace vat::script {

using Deadline = std::chrono::steady_clock::time_point;

struct Message {
  enum class Kind { text, binary, closed };
  Kind kind = Kind::text;
  std::string bytes;             ///< the message, or the reason given for closing
  std::uint16_t close_code = 0;  ///< 0: the connection broke
};

/// A WebSocket connection of a script.
class Client {
 public:
  virtual ~Client() = default;
  virtual void send_text(const std::string& text) = 0;
  virtual void send_binary(const std::string& bytes) = 0;
  virtual void close() = 0;
  /// `wanted` false: leaves messages in the socket until the next call with true.
  virtual void read(bool wanted) = 0;
  /// Returns the next message, or nothing if none came by the deadline. The last is `closed`.
  virtual std::optional<Message> next(Deadline deadline) = 0;
};

struct ConnectRequest {
  std::string path;                    ///< "": that of the URL
  std::string subprotocol = "vat.v1";  ///< "": none is asked for
};

/// An open connection, or the HTTP status of the refusal.
struct Connected {
  std::unique_ptr<Client> client;
  unsigned http_status = 101;
};
using Connect = std::function<Connected(const ConnectRequest&)>;
/// The answer to GET for a path, as fetch_http() gives it.
using Fetch = std::function<Json(const std::string& path, Deadline deadline)>;

/// Connects to a server. Throws std::runtime_error if that fails or it is not trusted.
Connected connect_websocket(const WebSocketUrl& url, const TlsTrust& trust,
                            const ConnectRequest& request, Deadline deadline);

}  // namespace vat::script
