#include "server/session/session_inbox.h"

#include <utility>

#include "core/support/check.h"

namespace vat {

SessionInbox::Added SessionInbox::add(Item& item) {
  const std::lock_guard lock(mutex_);
  if (is_closed_) return Added::refused;
  items_.push_back(std::move(item));
  return std::exchange(turn_scheduled_, true) ? Added::to_pending : Added::first;
}

std::optional<SessionInbox::Item> SessionInbox::take() {
  const std::lock_guard lock(mutex_);
  if (items_.empty()) {
    turn_scheduled_ = false;
    return {};
  }
  std::optional<Item> item(std::move(items_.front()));
  items_.pop_front();
  return item;
}

std::deque<SessionInbox::Item> SessionInbox::close() {
  const std::lock_guard lock(mutex_);
  VAT_CHECK(!is_closed_);
  is_closed_ = true;
  return std::exchange(items_, {});
}

}  // namespace vat
