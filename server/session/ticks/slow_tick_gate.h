#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace vat {

/// A semaphore that limits concurrent slow ticks to fewer than the pool's threads, so that a thread
/// remains free for fast ticks. Sessions without a place wait in a queue. Safe to use from any
/// thread. Must outlive all places.
class SlowTickGate {
 public:
  using Place = std::shared_ptr<void>;  ///< returned when the last copy is destroyed

  explicit SlowTickGate(std::size_t places) : free_(places) {}

  /// Returns a place, or null if none is free. In that case, `wake` is called later with the first
  /// released place, on the releasing thread. It must not block.
  Place take(std::function<void(Place)> wake);

 private:
  Place make_place();
  void release_place();

  std::mutex mutex_;
  std::size_t free_;
  std::deque<std::function<void(Place)>> queue_;
};

}  // namespace vat
