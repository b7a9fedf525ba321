#include "server/transport/ws_connection.h"

#include <utility>

namespace vat {

namespace {

/// Counts bytes from the call of send_*() until the socket has accepted them or they are discarded.
class QueuedBytes {
 public:
  QueuedBytes(std::shared_ptr<std::atomic<std::size_t>> total, std::size_t size)
      : total_(std::move(total)), size_(size) {
    *total_ += size_;
  }
  ~QueuedBytes() { *total_ -= size_; }
  QueuedBytes(const QueuedBytes&) = delete;
  QueuedBytes& operator=(const QueuedBytes&) = delete;

 private:
  std::shared_ptr<std::atomic<std::size_t>> total_;
  std::size_t size_;
};

}  // namespace

WsConnection::WsConnection(ConnectionId id, std::string address, std::shared_ptr<WsTaskQueue> tasks,
                           std::weak_ptr<WsStream> stream)
    : id_(id),
      address_(std::move(address)),
      tasks_(std::move(tasks)),
      stream_(std::move(stream)),
      queued_bytes_(std::make_shared<std::atomic<std::size_t>>(0)) {}

void WsConnection::send_text(std::string head, std::shared_ptr<const std::string> tail) {
  constexpr auto kText = websocketpp::frame::opcode::TEXT;
  if (tail != nullptr) return send(head, std::move(tail), kText);
  head.shrink_to_fit();  // may wait long, and often has unused capacity
  send({}, std::make_shared<const std::string>(std::move(head)), kText);
}

void WsConnection::send_binary(std::shared_ptr<const std::string> bytes) {
  send({}, std::move(bytes), websocketpp::frame::opcode::BINARY);
}

void WsConnection::send(const std::string& head, std::shared_ptr<const std::string> tail,
                        WsMessage::Opcode opcode) {
  if (!open_) return;
  auto queued = std::make_shared<QueuedBytes>(queued_bytes_, head.size() + tail->size());
  tasks_->send(stream_,
               std::make_shared<WsMessage>(opcode, std::move(tail), std::move(queued), head));
}

void WsConnection::close(std::uint16_t code, std::string_view reason) {
  if (!open_.exchange(false)) return;
  tasks_->close(stream_, code, std::string(reason));
}

}  // namespace vat
