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

/// Cache of states of a recording (RecordedMoment) in memory. If the size limit is exceeded, every
/// other moment is removed, and the work between later moments is doubled. Work is computing time.
/// Thread-safe.
class MomentCache {
 public:
  using Seconds = std::chrono::duration<double>;
  MomentCache(Seconds work, std::size_t most_bytes) : most_bytes_(most_bytes), work_(work) {}

  /// Returns the least work between two moments.
  Seconds work() const { return work_; }
  void add(RecordedMoment moment);
  /// Returns the last moment at or before a position, or null.
  std::shared_ptr<const RecordedMoment> find(std::uint64_t position) const;
  std::vector<std::uint64_t> positions() const;
  std::size_t count() const;
  std::size_t bytes() const;

 private:
  void thin();

  const std::size_t most_bytes_;
  std::atomic<Seconds> work_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<const RecordedMoment>> moments_;  ///< key: position
  std::size_t bytes_ = 0;
};

}  // namespace vat
