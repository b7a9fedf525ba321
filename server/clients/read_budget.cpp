#include "server/clients/read_budget.h"

namespace vat {

ReadBudget::ReadBudget(const Rate& bytes, const Rate& seconds, double burst_seconds,
                       SteadyClock::time_point now)
    : byte_rate_(bytes),
      second_rate_(seconds),
      bytes_(bytes.per_second, bytes.per_second * burst_seconds, now),
      seconds_(seconds.per_second, seconds.per_second * burst_seconds, now) {}

std::unique_ptr<ReadBudget> client_read_budget(const ServerLimits& limits,
                                               SteadyClock::time_point now) {
  const ReadBudget::Rate bytes{"read_bytes_per_second", limits.max_read_bytes_per_second};
  const ReadBudget::Rate seconds{"read_seconds_per_second", limits.max_read_seconds_per_second};
  return std::make_unique<ReadBudget>(bytes, seconds, limits.burst_seconds, now);
}

std::unique_ptr<ReadBudget> session_read_budget(const ServerLimits& limits,
                                                SteadyClock::time_point now) {
  const ReadBudget::Rate bytes{"session_read_bytes_per_second",
                               limits.max_session_read_bytes_per_second};
  const ReadBudget::Rate seconds{"session_read_seconds_per_second",
                                 limits.max_session_read_seconds_per_second};
  return std::make_unique<ReadBudget>(bytes, seconds, limits.burst_seconds, now);
}

std::optional<RateExcess> ReadBudget::find_excess(SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (const auto wait = bytes_.debt(now)) {
    return RateExcess{byte_rate_.limit, byte_rate_.per_second, *wait};
  }
  if (const auto wait = seconds_.debt(now)) {
    return RateExcess{second_rate_.limit, second_rate_.per_second, *wait};
  }
  return {};
}

void ReadBudget::charge(std::size_t bytes, std::chrono::duration<double> time,
                        SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  bytes_.charge(static_cast<double>(bytes), now);
  seconds_.charge(time.count(), now);
}

}  // namespace vat
