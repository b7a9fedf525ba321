#pragma once

#include <memory>

#include "core/device/opencl/devices.h"
#include "core/stepping/step_engine.h"

namespace vat {

/// Arithmetic of sums over pairs on a device.
enum class DeviceArithmetic : std::uint8_t {
  exact,  ///< correctly rounded operations: the same bits on every device
  fast,   ///< the arithmetic of the device, such as fused operations
};
template <>
inline constexpr std::array kNamesOf<DeviceArithmetic>{"exact", "fast"};

/// Returns an engine that takes the steps of weakly compressible liquids on an OpenCL device; see
/// find_features_not_on_device() for its scenes. Positions and velocities are in double precision,
/// and sums over pairs in single precision. The same device always computes the same bits. Fails
/// with the code "device_failed" if the kernels do not compile, and with "not_available" if the
/// device has no exact arithmetic but `arithmetic` is exact.
Result<std::unique_ptr<StepEngine>> make_tait_engine(const opencl::Device& device,
                                                     DeviceArithmetic arithmetic);

}  // namespace vat
