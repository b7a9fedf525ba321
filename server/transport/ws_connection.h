#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "server/transport/transport.h"
#include "server/transport/ws_task_queue.h"

namespace vat {

/// Connection that forwards all calls to the endpoint's thread. Only this thread uses the stream.
class WsConnection final : public Connection {
 public:
  WsConnection(ConnectionId id, std::string address, std::shared_ptr<WsTaskQueue> tasks,
               std::weak_ptr<WsStream> stream);

  ConnectionId id() const override { return id_; }
  const std::string& address() const override { return address_; }
  void send_text(std::string head, std::shared_ptr<const std::string> tail) override;
  void send_binary(std::shared_ptr<const std::string> bytes) override;
  std::size_t queued_bytes() const override { return *queued_bytes_; }
  void close(std::uint16_t code, std::string_view reason) override;

  /// Marks the peer as disconnected. Later calls have no effect.
  void set_gone() { open_ = false; }

 private:
  void send(const std::string& head, std::shared_ptr<const std::string> tail,
            WsMessage::Opcode opcode);

  ConnectionId id_;
  std::string address_;
  std::shared_ptr<WsTaskQueue> tasks_;
  std::weak_ptr<WsStream> stream_;
  std::shared_ptr<std::atomic<std::size_t>> queued_bytes_;
  std::atomic<bool> open_{true};
};

}  // namespace vat
