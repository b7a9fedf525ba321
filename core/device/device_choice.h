#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "core/device/tait/tait_engine.h"
#include "core/stepping/step_engine.h"
#include "core/support/result.h"

namespace vat {

/// The device that takes the steps of a simulation.
struct DeviceChoice {
  bool is_cpu = true;
  bool is_auto = false;   ///< the faster one of the CPU and the first device
  std::size_t index = 0;  ///< index in opencl::list_devices()
  DeviceArithmetic arithmetic = DeviceArithmetic::exact;
};

inline constexpr const char* kDeviceForm =
    "cpu, auto, opencl, opencl:N, opencl:fast or opencl:N:fast";

/// Returns the choice of a text in the form kDeviceForm. Fails with the code "bad_value".
Result<DeviceChoice> parse_device(std::string_view text);

/// Returns the engine of the device, or null for the CPU. The choice must not be automatic. Fails
/// like opencl::find_device() and make_tait_engine().
Result<std::unique_ptr<StepEngine>> make_engine(const DeviceChoice& choice);

}  // namespace vat
