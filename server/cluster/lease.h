#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>

#include "server/support/clock.h"

namespace vat {

/// Right of this node to own sessions, for a limited time after each confirmed renewal. The node
/// measures the time from the sending of the renewal, and the other nodes from its arrival. The
/// node's time is shorter, so the lease ends for the node before another node takes its sessions.
/// No two machines compare their clocks. Thread-safe.
class Lease {
 public:
  static constexpr std::chrono::milliseconds kHolderTime{2000};  ///< time for the holder
  static constexpr std::chrono::milliseconds kOthersTime{3000};  ///< time for the other nodes
  static constexpr std::chrono::milliseconds kLeastRenewal{500};
  static constexpr std::chrono::milliseconds kGreatestRenewal{1000};  ///< two in kHolderTime

  /// Returns the interval of renewals in a cluster of `nodes` nodes. NATS sends each renewal to all
  /// nodes, so the interval is longer in large clusters.
  static constexpr std::chrono::milliseconds renewal_interval(std::size_t nodes) {
    constexpr std::chrono::milliseconds kOfNode{5};
    return std::clamp(static_cast<int>(std::min<std::size_t>(nodes, 1000)) * kOfNode, kLeastRenewal,
                      kGreatestRenewal);
  }

  explicit Lease(const Clock& clock) : clock_(clock) {}

  /// Returns whether the node may act as the owner of its sessions now.
  bool is_valid() const {
    return clock_.now().time_since_epoch().count() < until_.load(std::memory_order_relaxed);
  }
  /// Notes the confirmation of a renewal that was sent at `sent`. Returns false if the lease had
  /// expired. The lease then remains invalid until reopen(), because another node may have taken
  /// sessions.
  bool confirm(SteadyClock::time_point sent);
  /// Makes the lease valid after the node has checked its sessions. `sent` is the time of the
  /// renewal before the check. Returns false if that renewal has expired.
  bool reopen(SteadyClock::time_point sent);
  /// Ends the lease.
  void end();
  /// Returns the time since which the lease is valid without a gap.
  SteadyClock::time_point held_since() const;

 private:
  bool is_before(SteadyClock::time_point end) const { return clock_.now() < end; }

  const Clock& clock_;
  std::atomic<SteadyClock::rep> until_ = 0;  // 0: invalid
  mutable std::mutex mutex_;                 // guards the members below, and writes of `until_`
  SteadyClock::time_point confirmed_until_{};
  SteadyClock::time_point held_since_{};
};

}  // namespace vat
