#pragma once

#include <memory>

#include "core/device/common/device_method.h"
#include "core/device/opencl/program.h"

namespace vat {

/// Returns the bytes that the steps of a model without liquids need on the device.
std::size_t bytes_for_solids(const Model& model);

/// Returns the steps of deformable and rigid bodies by velocity Verlet, with the kernels of
/// core/device/solid. Throws opencl::DeviceFailure.
std::unique_ptr<DeviceMethod> make_solid_method(opencl::Program& program,
                                                std::shared_ptr<const Model> model);

}  // namespace vat
