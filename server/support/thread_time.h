#pragma once

#include <chrono>
#include <ctime>

namespace vat {

/// Returns the processor time of this thread.
inline std::chrono::duration<double> thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace vat
