#pragma once

#include <memory>

#include "core/device/opencl/devices.h"
#include "core/scene/device_choice.h"
#include "core/stepping/step_engine.h"

namespace vat {

/// Returns an engine that takes the steps of liquids on an OpenCL device; see
/// find_features_not_on_device() for its scenes. Positions and velocities are in double precision,
/// and sums over pairs in single precision. The same device always computes the same bits. Fails
/// with the code "device_failed" if the kernels do not compile, and with "not_available" if the
/// device has no exact arithmetic but `arithmetic` is exact.
Result<std::unique_ptr<StepEngine>> make_device_engine(const opencl::Device& device,
                                                       DeviceArithmetic arithmetic);

}  // namespace vat
