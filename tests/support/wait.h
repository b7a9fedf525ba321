#pragma once

#include <chrono>
#include <thread>

#include "tests/support/patience.h"

namespace vat::test {

/// Waits for a condition that no event announces: the state of another process, of a socket or of
/// a thread without a notification. False if the condition is still false after `limit`.
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

/// Lets real time pass. Only for tests whose subject is real time: peers of the transport, whose
/// timers are those of its library, and the processor time of threads that wait.
inline void pause(std::chrono::milliseconds time) {
  std::this_thread::sleep_for(time);
}

}  // namespace vat::test
