#include "server/net/ws_connection.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace vat {

namespace {

/// Counts bytes from the call of send_*() until the socket has taken them, or never will.
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

/// What fits into a close frame. Ends before a whole character: the library refuses half a one.
std::string fit_reason(const std::string& reason) {
  constexpr std::size_t kMaxSize = websocketpp::frame::limits::close_reason_size;
  std::size_t size = std::min(reason.size(), kMaxSize);
  if (size < reason.size()) {
    const auto inside_character = [](char byte) { return (byte & 0xc0) == 0x80; };
    while (size > 0 && inside_character(reason[size])) --size;
  }
  return reason.substr(0, size);
}

}  // namespace

WsConnection::WsConnection(ConnectionId id, std::shared_ptr<boost::asio::io_context> io,
                           std::weak_ptr<WsStream> stream)
    : id_(id),
      io_(std::move(io)),
      stream_(std::move(stream)),
      queued_bytes_(std::make_shared<std::atomic<std::size_t>>(0)) {}

void WsConnection::send_text(std::string message) {
  send(std::make_shared<const std::string>(std::move(message)), websocketpp::frame::opcode::TEXT);
}

void WsConnection::send_binary(std::shared_ptr<const std::string> bytes) {
  send(std::move(bytes), websocketpp::frame::opcode::BINARY);
}

void WsConnection::send(std::shared_ptr<const std::string> payload, WsMessage::Opcode opcode) {
  if (!open_) return;
  auto queued = std::make_shared<QueuedBytes>(queued_bytes_, payload->size());
  auto message = std::make_shared<WsMessage>(opcode, std::move(payload), std::move(queued));
  boost::asio::post(*io_, [stream = stream_, message = std::move(message)] {
    // A stream that is no longer open refuses the message, which is then dropped as promised.
    if (const auto alive = stream.lock()) alive->send(message);
  });
}

void WsConnection::close(std::uint16_t code, std::string_view reason) {
  if (!open_.exchange(false)) return;
  boost::asio::post(*io_, [stream = stream_, code, reason = std::string(reason)] {
    if (const auto alive = stream.lock()) close_stream(*alive, code, reason);
  });
}

void close_stream(WsStream& stream, std::uint16_t code, const std::string& reason) {
  if (stream.get_state() != websocketpp::session::state::open) return;
  websocketpp::lib::error_code error;
  stream.close(code, fit_reason(reason), error);
  if (error) stream.terminate(error);
}

}  // namespace vat
