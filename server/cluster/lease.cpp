#include "server/cluster/lease.h"

#include <algorithm>

namespace vat {

bool Lease::confirm(SteadyClock::time_point sent) {
  const std::lock_guard lock(mutex_);
  const bool was_valid = is_valid();
  confirmed_until_ = std::max(confirmed_until_, sent + kHolderTime);
  until_ = was_valid ? confirmed_until_.time_since_epoch().count() : 0;
  return was_valid;
}

bool Lease::reopen(SteadyClock::time_point sent) {
  const std::lock_guard lock(mutex_);
  if (!is_before(sent + kHolderTime)) return false;
  until_ = confirmed_until_.time_since_epoch().count();
  held_since_ = clock_.now();
  return true;
}

void Lease::end() {
  const std::lock_guard lock(mutex_);
  until_ = 0;
}

SteadyClock::time_point Lease::held_since() const {
  const std::lock_guard lock(mutex_);
  return held_since_;
}

}  // namespace vat
