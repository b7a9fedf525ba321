#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace vat {

/// Semaphore for concurrent slow ticks. The gate has fewer places than the pool has threads, so
/// that one thread remains free for fast ticks. Sessions without a place wait in a queue.
/// Thread-safe. Must outlive all places.
class SlowTickGate {
 public:
  using Place = std::shared_ptr<void>;  ///< released when the last copy is destroyed

  explicit SlowTickGate(std::size_t places) : free_(places) {}

  /// Returns a place, or null if no place is free. If no place is free, the releasing thread later
  /// calls `wake` with the first released place. `wake` must not block.
  Place take(std::function<void(Place)> wake);

 private:
  Place make_place();
  void release_place();

  std::mutex mutex_;
  std::size_t free_;
  std::deque<std::function<void(Place)>> queue_;
};

}  // namespace vat
