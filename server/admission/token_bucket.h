#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "server/clock.h"

namespace vat {

/// Allows `rate` a second on average, and `burst` at once. Used by one thread at a time.
class TokenBucket {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Full at first.
  TokenBucket(double rate, double burst, SteadyClock::time_point now)
      : rate_(rate), burst_(burst), level_(burst), filled_at_(now) {}

  /// Takes the amount, or nothing, and tells after which time there will be enough. More than a
  /// burst is taken where the bucket is full, and owed.
  std::optional<Seconds> take(double amount, SteadyClock::time_point now) {
    level_ = std::min(burst_, level_ + rate_ * Seconds(now - filled_at_).count());
    filled_at_ = now;
    const double needed = std::min(amount, burst_);
    if (level_ < needed) return Seconds((needed - level_) / rate_);
    level_ -= amount;
    return {};
  }

 private:
  double rate_;
  double burst_;
  double level_;
  SteadyClock::time_point filled_at_;
};

}  // namespace vat
