#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>

#include "server/messages/limits.h"
#include "server/messages/method_row.h"
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

/// Rate that a message exceeds.
struct RateExcess {
  std::string_view limit;  ///< its name in server.info's `limits`
  double maximum = 0;      ///< its value
  TokenBucket::Seconds retry_after{};
  /// The connection has sent so many refused messages that it must be closed.
  bool is_flood = false;
};

/// Counts the messages of one connection against its rate limits. Used by one thread at a time.
class MessageMeter {
 public:
  MessageMeter(const ServerLimits& limits, SteadyClock::time_point now);

  /// Counts the bytes of a message before it is read.
  std::optional<RateExcess> count_bytes(std::size_t bytes, SteadyClock::time_point now);
  /// Counts the message in its class.
  std::optional<RateExcess> count(RateClass rate_class, SteadyClock::time_point now);

 private:
  struct Limit {
    std::string_view name;
    double rate;
    TokenBucket bucket;
  };
  std::optional<RateExcess> take(Limit& limit, double amount, SteadyClock::time_point now);

  Limit bytes_;
  std::array<Limit, kNamesOf<RateClass>.size()> classes_;
  TokenBucket refusals_;
};

}  // namespace vat
