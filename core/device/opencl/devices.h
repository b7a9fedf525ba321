#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/device/opencl/api.h"
#include "core/support/result.h"

namespace vat::opencl {

/// Greatest number of lanes of a device.
inline constexpr std::uint32_t kMostLanes = 16;

struct Device {
  cl_device_id id = nullptr;
  std::string name;
  std::string driver;                 ///< name of the platform and version of the driver
  std::uint64_t memory = 0;           ///< [bytes]
  std::uint64_t greatest_buffer = 0;  ///< [bytes]
  /// Memory that the buffers of this process have [bytes]. Null if there are no buffers.
  std::atomic<std::uint64_t>* used_memory = nullptr;
  std::uint32_t compute_units = 0;
  /// Particles whose sums over pairs a work-item computes in vectors: 16 on CPUs, 1 on others.
  std::uint32_t lanes = 1;
  bool has_doubles = false;  ///< arithmetic in double precision, which vat needs
  bool is_exact = false;     ///< can round divisions and square roots correctly
};

/// Returns the devices of all platforms, in the order of the library. The list is empty if the
/// machine has no device. Fails like load_api().
Result<std::vector<Device>> list_devices();

/// Returns the device with this index in list_devices(). Fails with the code "not_available" if
/// there is no such device, or if it has no double precision.
Result<Device> find_device(std::size_t index);

}  // namespace vat::opencl
