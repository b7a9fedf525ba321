#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "server/clients/message_meter.h"

namespace vat {

/// Limits of the reads of a client or of a session: bytes of the results, and processor time. The
/// cost of a read is known only afterwards. A read is therefore accepted if earlier reads have not
/// used more than their limits. Thread-safe.
class ReadBudget {
 public:
  struct Rate {
    std::string_view limit;  ///< name in server.info's `limits`
    double per_second = 0;
  };
  /// `bytes` is in [B/s], `seconds` in [s/s]. A burst has `burst_seconds` times the rate.
  ReadBudget(const Rate& bytes, const Rate& seconds, double burst_seconds,
             SteadyClock::time_point now);

  /// Returns the limit that earlier reads exceed, or nothing if another read is accepted.
  std::optional<RateExcess> find_excess(SteadyClock::time_point now);
  /// Charges the cost of a read.
  void charge(std::size_t bytes, std::chrono::duration<double> time, SteadyClock::time_point now);

 private:
  std::mutex mutex_;
  const Rate byte_rate_;
  const Rate second_rate_;
  TokenBucket bytes_;
  TokenBucket seconds_;
};

/// Return the budgets of one client and of one session.
std::unique_ptr<ReadBudget> client_read_budget(const ServerLimits& limits,
                                               SteadyClock::time_point now);
std::unique_ptr<ReadBudget> session_read_budget(const ServerLimits& limits,
                                                SteadyClock::time_point now);

}  // namespace vat
