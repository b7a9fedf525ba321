#include "server/session/ticks/slow_tick_gate.h"

#include <utility>
#include "core/support/check.h"

namespace vat {

SlowTickGate::Place SlowTickGate::take(std::function<void(Place)> wake) {
  VAT_CHECK(wake != nullptr);
  const std::lock_guard lock(mutex_);
  if (free_ == 0) {
    queue_.push_back(std::move(wake));
    return nullptr;
  }
  --free_;
  return make_place();
}

SlowTickGate::Place SlowTickGate::make_place() {
  return {this, [](SlowTickGate* all) { all->release_place(); }};
}

void SlowTickGate::release_place() {
  std::function<void(Place)> first;
  {
    const std::lock_guard lock(mutex_);
    if (queue_.empty()) {
      ++free_;
      return;
    }
    first = std::move(queue_.front());
    queue_.pop_front();
  }
  first(make_place());
}

}  // namespace vat
