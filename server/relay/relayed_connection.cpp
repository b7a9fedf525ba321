#include "server/relay/relayed_connection.h"

#include <utility>

namespace vat {

void RelayedConnection::send_text(std::string head, std::shared_ptr<const std::string> tail) {
  if (tail != nullptr) head += *tail;
  send(RelayKind::text, std::move(head));
}

void RelayedConnection::send_binary(std::shared_ptr<const std::string> bytes) {
  send(RelayKind::frame, *bytes);
}

void RelayedConnection::send(RelayKind kind, std::string body) {
  if (is_closed_ || line_->send(kind, Json::object(), std::move(body))) return;
  if (!is_closed_.exchange(true)) closed_();
}

void RelayedConnection::close(std::uint16_t code, std::string_view reason) {
  if (is_closed_.exchange(true)) return;
  line_->send(RelayKind::end, {{"code", code}, {"reason", reason}});
  closed_();
}

}  // namespace vat
