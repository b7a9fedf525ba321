#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace vat {

/// Places for slow ticks, fewer than the pool has threads, so that a thread stays free for fast
/// ticks. Sessions without a place wait in a queue. Safe to use from any thread. Must outlive all
/// places.
class SlowTickGate {
 public:
  using Place = std::shared_ptr<void>;  ///< returned when the last copy is destroyed

  explicit SlowTickGate(std::size_t places) : free_(places) {}

  /// Returns a place, or null if none is free. `wake` then receives the first free one, on the
  /// thread that returned it, and must not block.
  Place take(std::function<void(Place)> wake);

 private:
  Place make_place();
  void release_place();

  std::mutex mutex_;
  std::size_t free_;
  std::deque<std::function<void(Place)>> queue_;
};

}  // namespace vat
