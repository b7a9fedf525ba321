#pragma once

#include <memory>
#include <optional>
#include <string>

#include "protocol/client/connection/connection.h"

namespace vat::client {

/// Connection by TCP, with TLS if the URL requires TLS. All functions except wake() and cancel()
/// run on one thread.
class WebSocket final : public Connection {
 public:
  /// Throws std::runtime_error if the certificates of `trust` cannot be read.
  WebSocket(const WebSocketUrl& url, const TlsTrust& trust);
  ~WebSocket() override;
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// Returns the HTTP status of the server's reply. The connection is open if the status is 101.
  /// Throws UntrustedServer, or std::runtime_error with the cause if the connection fails or
  /// cancel() is called. The look-up of the host's name ignores the deadline.
  unsigned connect(const ConnectRequest& request, Deadline deadline);

  void send_text(const std::string& text) override;
  void send_binary(const std::string& bytes) override;
  void close() override;
  void read(bool wanted) override;
  std::optional<Message> next(Deadline deadline) override;

  /// Ends the running or following next() without a message. All threads may call this function.
  void wake();
  /// As wake(), and ends a running or following connect(). All threads may call this function.
  void cancel();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vat::client
