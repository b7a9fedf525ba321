#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "server/replay/recording.h"

namespace vat {

/// Moments of a recording that are kept in memory beside its own, of so many bytes at most: beyond
/// them every other one goes, and so much more work has to lie between those that come. Safe to use
/// from any thread.
class KeptMoments {
 public:
  using Seconds = std::chrono::duration<double>;
  KeptMoments(Seconds work, std::size_t most_bytes) : most_bytes_(most_bytes), work_(work) {}

  /// How much work has to lie between two.
  Seconds work() const { return work_; }
  void add(RecordedMoment moment);
  /// The last one at a position or before it, or null.
  std::shared_ptr<const RecordedMoment> find(std::uint64_t position) const;
  std::vector<std::uint64_t> positions() const;
  std::size_t count() const;
  std::size_t bytes() const;

 private:
  void thin();

  const std::size_t most_bytes_;
  std::atomic<Seconds> work_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<const RecordedMoment>> moments_;  ///< by position
  std::size_t bytes_ = 0;
};

}  // namespace vat
