#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "server/admission/token_bucket.h"
#include "server/limits.h"
#include "server/session/method_rules.h"

namespace vat {

/// Why a message is refused for coming too soon.
struct RateExcess {
  std::string_view limit;  ///< the name in server.info's `limits`
  double maximum = 0;      ///< its value
  TokenBucket::Seconds retry_after{};
  /// So many have been refused before that the connection is to be closed.
  bool is_flood = false;
};

/// Counts the messages of one connection against the limits per second. Used by one thread at a
/// time.
class MessageMeter {
 public:
  MessageMeter(const ServerLimits& limits, SteadyClock::time_point now);

  /// Before the message is read.
  std::optional<RateExcess> count_bytes(std::size_t bytes, SteadyClock::time_point now);
  /// Once it is known what it counts as.
  std::optional<RateExcess> count(MessageClass message_class, SteadyClock::time_point now);

 private:
  struct Limit {
    std::string_view name;
    double rate;
    TokenBucket bucket;
  };
  std::optional<RateExcess> take(Limit& limit, double amount, SteadyClock::time_point now);

  Limit bytes_;
  std::array<Limit, kMessageClasses> classes_;
  TokenBucket refusals_;
};

}  // namespace vat
