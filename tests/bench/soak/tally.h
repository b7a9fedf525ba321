#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace vat::bench {

/// Actions and failures of the clients of a soak.
struct Tally {
  std::atomic<std::uint64_t> joins = 0;
  std::atomic<std::uint64_t> requests = 0;  ///< answered requests of well-behaved clients
  std::atomic<std::uint64_t> refused = 0;   ///< refused ones among them
  std::atomic<std::uint64_t> frames = 0;
  std::atomic<std::uint64_t> garbage = 0;  ///< invalid messages
  std::atomic<std::uint64_t> flood = 0;    ///< messages of clients that exceed the rate
  /// Connections that the server closed, of these two kinds or because the client was too slow.
  std::atomic<std::uint64_t> closed = 0;
  std::atomic<std::uint64_t> stalls = 0;
  std::atomic<std::uint64_t> recordings = 0;  ///< downloaded recordings

  void add_fault(const std::string& fault) {
    const std::lock_guard lock(mutex_);
    if (faults_.size() < kMaxFaults) faults_.push_back(fault);
  }
  std::vector<std::string> faults() const {
    const std::lock_guard lock(mutex_);
    return faults_;
  }
  /// Returns the longest response time [s].
  double longest() const {
    const std::lock_guard lock(mutex_);
    return longest_;
  }
  void add_wait(double seconds) {
    const std::lock_guard lock(mutex_);
    longest_ = seconds > longest_ ? seconds : longest_;
  }

 private:
  static constexpr std::size_t kMaxFaults = 20;
  mutable std::mutex mutex_;
  std::vector<std::string> faults_;
  double longest_ = 0;
};

}  // namespace vat::bench
