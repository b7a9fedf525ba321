#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "server/support/clock.h"

namespace vat {

/// Limit of `rate` events per second on average and `burst` events at once. Not thread-safe.
class TokenBucket {
 public:
  using Seconds = std::chrono::duration<double>;

  /// The bucket is initially full.
  TokenBucket(double rate, double burst, SteadyClock::time_point now)
      : rate_(rate), burst_(burst), level_(burst), filled_at_(now) {}

  /// Takes an amount from the bucket. If the level is too low, takes nothing and returns the
  /// waiting time. An amount above `burst` requires a full bucket, and the level then becomes
  /// negative.
  std::optional<Seconds> take(double amount, SteadyClock::time_point now) {
    fill(now);
    const double needed = std::min(amount, burst_);
    if (level_ < needed) return Seconds((needed - level_) / rate_);
    level_ -= amount;
    return {};
  }

  /// Takes an amount even if the level is too low. The level may become negative.
  void charge(double amount, SteadyClock::time_point now) {
    fill(now);
    level_ -= amount;
  }
  /// Returns the time after which the level is no longer negative, or nothing if it is not.
  std::optional<Seconds> debt(SteadyClock::time_point now) {
    fill(now);
    if (level_ >= 0) return {};
    return Seconds(-level_ / rate_);
  }

 private:
  void fill(SteadyClock::time_point now) {
    level_ = std::min(burst_, level_ + rate_ * Seconds(now - filled_at_).count());
    filled_at_ = now;
  }

  double rate_;
  double burst_;
  double level_;
  SteadyClock::time_point filled_at_;
};

}  // namespace vat
