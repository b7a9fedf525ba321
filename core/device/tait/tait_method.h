#pragma once

#include <memory>

#include "core/device/common/device_method.h"
#include "core/device/opencl/program.h"

namespace vat {

/// Returns the bytes that the steps of the solver `tait` need on the device.
std::size_t bytes_for_tait(const Model& model);

/// Returns the steps of a weakly compressible liquid, with the kernels of tait/step.cl. Throws
/// opencl::DeviceFailure.
std::unique_ptr<DeviceMethod> make_tait_method(opencl::Program& program,
                                               std::shared_ptr<const Model> model);

}  // namespace vat
