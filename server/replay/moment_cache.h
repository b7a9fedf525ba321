#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "server/history/recording.h"

namespace vat {

/// Moments of a recording in memory, in addition to its own. If they exceed the size limit, every
/// other one is removed, and the work between later ones doubles. Safe to use from any thread.
class MomentCache {
 public:
  using Seconds = std::chrono::duration<double>;
  MomentCache(Seconds work, std::size_t most_bytes) : most_bytes_(most_bytes), work_(work) {}

  /// Least work between two moments.
  Seconds work() const { return work_; }
  void add(RecordedMoment moment);
  /// Returns the last one at or before a position, or null.
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
