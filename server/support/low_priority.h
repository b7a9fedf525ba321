#pragma once

#include <sys/resource.h>

#include <thread>  // pthread_setname_np

namespace vat {

/// Lowers the priority of the calling thread, and names the thread. A refusal of the system is
/// ignored: the thread then competes equally with others. `niceness` is 0 (normal) to 19 (lowest).
inline void lower_thread_priority(int niceness, const char* name) {
  setpriority(PRIO_PROCESS, 0, niceness);  // of a thread, on Linux
  pthread_setname_np(pthread_self(), name);
}

}  // namespace vat
