#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "server/messages/limits.h"
#include "server/messages/method_row.h"
#include "server/support/token_bucket.h"

namespace vat {

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
