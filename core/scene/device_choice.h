#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/names.h"
#include "core/support/result.h"

namespace vat {

/// Arithmetic of sums over pairs on a device.
enum class DeviceArithmetic : std::uint8_t {
  exact,  ///< correctly rounded operations: the same bits on every device
  fast,   ///< the arithmetic of the device, such as fused operations
};
template <>
inline constexpr std::array kNamesOf<DeviceArithmetic>{"exact", "fast"};

/// The device that takes the steps of a simulation.
struct DeviceChoice {
  bool is_cpu = true;
  bool is_auto = false;   ///< the faster one of the CPU and the first device
  std::size_t index = 0;  ///< index in opencl::list_devices()
  DeviceArithmetic arithmetic = DeviceArithmetic::exact;

  bool operator==(const DeviceChoice&) const = default;
};

inline constexpr const char* kDeviceForm =
    "cpu, auto, opencl, opencl:N, opencl:fast or opencl:N:fast";

/// Returns the choice of a text in the form kDeviceForm. N has at most nine digits. Fails with the
/// code "bad_value".
Result<DeviceChoice> parse_device(std::string_view text);

/// Returns a text for parse_device(), such as "opencl:0" or "opencl:1:fast".
std::string to_text(const DeviceChoice& choice);

}  // namespace vat
