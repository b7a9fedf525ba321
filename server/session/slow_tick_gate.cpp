#include "server/session/slow_tick_gate.h"

#include <utility>

namespace vat {

SlowTickGate::Place SlowTickGate::take(std::function<void(Place)> wake) {
  const std::lock_guard lock(mutex_);
  if (free_ == 0) {
    line_.push_back(std::move(wake));
    return nullptr;
  }
  --free_;
  return make_place();
}

SlowTickGate::Place SlowTickGate::make_place() {
  return {this, [](SlowTickGate* all) { all->give_back(); }};
}

void SlowTickGate::give_back() {
  std::function<void(Place)> first;
  {
    const std::lock_guard lock(mutex_);
    if (line_.empty()) {
      ++free_;
      return;
    }
    first = std::move(line_.front());
    line_.pop_front();
  }
  first(make_place());
}

}  // namespace vat
