#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "server/support/clock.h"

namespace vat {

/// Limits events to `rate` per second on average, and `burst` at once. Used by one thread at a
/// time.
class TokenBucket {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Initially full.
  TokenBucket(double rate, double burst, SteadyClock::time_point now)
      : rate_(rate), burst_(burst), level_(burst), filled_at_(now) {}

  /// Takes the amount. If it is not available, takes nothing and returns the time until it is. An
  /// amount above a burst is taken from a full bucket, and the rest is owed.
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
