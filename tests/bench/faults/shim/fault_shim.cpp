// Library that is preloaded into a server, and injects the faults of a FaultControl: syncs that
// wait, steps of the system time, and use of memory.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>  // NOLINT: the C header declares clock_gettime
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/bench/faults/fault_control.h"

namespace vat::bench {
namespace {

constexpr std::chrono::milliseconds kShimInterval{2};
constexpr std::int64_t kNanoseconds = 1'000'000'000;

FaultControl* open_control() {
  const char* const path = std::getenv(kFaultVariable);
  const int file = path == nullptr ? -1 : open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) std::abort();
  void* const memory =
      mmap(nullptr, sizeof(FaultControl), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) std::abort();
  return static_cast<FaultControl*>(memory);
}

FaultControl& control() {
  static FaultControl* const control = open_control();
  return *control;
}

void wait_for_disk() {
  if (control().disk_paused == 0) return;
  ++control().delayed_syncs;
  while (control().disk_paused != 0) std::this_thread::sleep_for(kShimInterval);
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));  // NOLINT: as dlsym requires
}

[[noreturn]] void hold_ballast() {
  void* memory = nullptr;
  std::size_t held = 0;
  for (;; std::this_thread::sleep_for(kShimInterval)) {
    const auto wanted = static_cast<std::size_t>(control().ballast.load());
    if (wanted == held) continue;
    if (held > 0) munmap(memory, held);
    held = wanted;
    if (held == 0) continue;
    memory = mmap(nullptr, held, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) std::abort();
    std::memset(memory, 1, held);
  }
}

[[gnu::constructor]] void begin() {
  unsetenv("LD_PRELOAD");  // the server's own processes have no faults
  std::thread(hold_ballast).detach();
}

}  // namespace
}  // namespace vat::bench

extern "C" {

int fsync(int file) {
  static auto* const real = vat::bench::next<int(int)>("fsync");
  vat::bench::wait_for_disk();
  return real(file);
}

int fdatasync(int file) {
  static auto* const real = vat::bench::next<int(int)>("fdatasync");
  vat::bench::wait_for_disk();
  return real(file);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static auto* const real = vat::bench::next<int(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (result != 0 || clock != CLOCK_REALTIME) return result;
  const std::int64_t sum = std::int64_t{time->tv_sec} * vat::bench::kNanoseconds + time->tv_nsec +
                           vat::bench::control().clock_step;
  time->tv_sec = sum / vat::bench::kNanoseconds;
  time->tv_nsec = sum % vat::bench::kNanoseconds;
  return 0;
}

}  // extern "C"
