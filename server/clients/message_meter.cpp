#include "server/clients/message_meter.h"
#include "core/support/check.h"

namespace vat {

MessageMeter::MessageMeter(const ServerLimits& limits, SteadyClock::time_point now)
    : bytes_{"message_bytes_per_second", limits.max_message_bytes_per_second,
             TokenBucket(limits.max_message_bytes_per_second,
                         limits.max_message_bytes_per_second * limits.burst_seconds, now)},
      classes_([&] {
        const auto limit = [&](std::string_view name, double rate) {
          return Limit{name, rate, TokenBucket(rate, rate * limits.burst_seconds, now)};
        };
        return std::array{limit("queries_per_second", limits.max_queries_per_second),
                          limit("controls_per_second", limits.max_controls_per_second),
                          limit("pointer_moves_per_second", limits.max_pointer_moves_per_second),
                          limit("scenes_per_second", limits.max_scenes_per_second),
                          limit("reads_per_second", limits.max_reads_per_second)};
      }()),
      refusals_(limits.max_refusals_per_second,
                limits.max_refusals_per_second * limits.burst_seconds, now) {}

std::optional<RateExcess> MessageMeter::count_bytes(std::size_t bytes,
                                                    SteadyClock::time_point now) {
  return take(bytes_, static_cast<double>(bytes), now);
}

std::optional<RateExcess> MessageMeter::count(RateClass rate_class, SteadyClock::time_point now) {
  VAT_CHECK(static_cast<std::size_t>(rate_class) < classes_.size());
  return take(classes_[static_cast<std::size_t>(rate_class)], 1, now);
}

std::optional<RateExcess> MessageMeter::take(Limit& limit, double amount,
                                             SteadyClock::time_point now) {
  const auto wait = limit.bucket.take(amount, now);
  if (!wait) return {};
  return RateExcess{limit.name, limit.rate, *wait, refusals_.take(1, now).has_value()};
}

}  // namespace vat
