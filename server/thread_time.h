#pragma once

#include <chrono>
#include <ctime>

namespace vat {

/// What this thread has worked so far, without what it has waited.
inline std::chrono::duration<double> thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace vat
