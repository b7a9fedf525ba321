#pragma once

#include <chrono>
#include <thread>

#include "tests/support/patience.h"

namespace vat::test {

/// Waits for a condition without an event: the state of another process, of a socket, or of a
/// thread without a notification. Returns false if the condition is still false after `limit`.
template <class Condition>
bool wait_until(const Condition& condition,
                std::chrono::seconds limit = std::chrono::seconds(60 * kSlowdown)) {
  constexpr std::chrono::milliseconds kInterval(2);
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kInterval);
  }
  return true;
}

/// Waits for real time. Only for tests of real time: peers of the transport, whose library sets the
/// timers, and the processor time of waiting threads.
inline void pause(std::chrono::milliseconds time) {
  std::this_thread::sleep_for(time);
}

}  // namespace vat::test
