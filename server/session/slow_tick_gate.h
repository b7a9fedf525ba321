#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace vat {

/// Places for ticks that take long, fewer than the sessions have threads: so there is always a
/// thread for the short ones, and the system shares the cores between both. Who finds no place
/// waits in line. Safe to use from any thread; must outlive all places.
class SlowTickGate {
 public:
  using Place = std::shared_ptr<void>;  ///< given back where the last copy goes

  explicit SlowTickGate(std::size_t places) : free_(places) {}

  /// A place, or null where there is none: `wake` then gets the first that is free for it, on the
  /// thread that gave it back. It must not wait.
  Place take(std::function<void(Place)> wake);

 private:
  Place make_place();
  void give_back();

  std::mutex mutex_;
  std::size_t free_;
  std::deque<std::function<void(Place)>> line_;
};

}  // namespace vat
