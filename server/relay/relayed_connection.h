#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "server/relay/relay_message.h"
#include "server/transport/transport.h"

namespace vat {

/// Connection of a client, or of a relay's viewers, through another node. See Connection.
class RelayedConnection final : public Connection {
 public:
  /// `closed` is called once, when the connection ends by close() or by a failure. It must not
  /// wait.
  RelayedConnection(ConnectionId id, std::string address, std::shared_ptr<RelayLine> line,
                    std::function<void()> closed)
      : id_(id), address_(std::move(address)), line_(std::move(line)), closed_(std::move(closed)) {}

  ConnectionId id() const override { return id_; }
  const std::string& address() const override { return address_; }
  void send_text(std::string head, std::shared_ptr<const std::string> tail) override;
  void send_binary(std::shared_ptr<const std::string> bytes) override;
  /// Returns 0. The window of frames limits the memory of frames.
  std::size_t queued_bytes() const override { return 0; }
  void close(std::uint16_t code, std::string_view reason) override;
  /// Ends the connection without a message, because the other node has ended it.
  void abandon() { is_closed_ = true; }

 private:
  void send(RelayKind kind, std::string body);

  const ConnectionId id_;
  const std::string address_;
  const std::shared_ptr<RelayLine> line_;
  const std::function<void()> closed_;
  std::atomic<bool> is_closed_ = false;
};

}  // namespace vat
