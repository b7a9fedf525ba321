#pragma once

#include <atomic>
#include <cstdint>

namespace vat::bench {

/// Name of the environment variable with the path of the file that contains the FaultControl.
inline constexpr const char* kFaultVariable = "FAULT_CONTROL";

/// Faults of the system under a server, in memory that the server's process shares with the
/// benchmark. The library vat_fault_shim, which is loaded into the server, injects them.
struct FaultControl {
  std::atomic<std::uint32_t> disk_paused = 0;  ///< 1: fsync and fdatasync wait
  std::atomic<std::uint32_t> delayed_syncs = 0;
  std::atomic<std::int64_t> clock_step = 0;  ///< added to the system time [ns]
  std::atomic<std::int64_t> ballast = 0;  ///< memory that the process must use in addition [bytes]
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace vat::bench
