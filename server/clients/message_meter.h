#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>

#include "server/messages/limits.h"
#include "server/messages/method_row.h"
#include "server/support/clock.h"
#include "server/support/token_bucket.h"

namespace vat {

/// Rate limit that a message exceeds.
struct RateExcess {
  std::string_view limit;  ///< name in server.info's `limits`
  double maximum = 0;      ///< value of the limit
  TokenBucket::Seconds retry_after{};
  /// True if the connection has sent so many refused messages that it must be closed.
  bool is_flood = false;
};

/// Counter of one connection's messages, with its rate limits. Not thread-safe.
class MessageMeter {
 public:
  MessageMeter(const ServerLimits& limits, SteadyClock::time_point now);

  /// Counts the bytes of a message before the message is parsed.
  std::optional<RateExcess> count_bytes(std::size_t bytes, SteadyClock::time_point now);
  /// Counts a message in its rate class.
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
