#pragma once

#include <memory>

#include "core/device/common/device_method.h"
#include "core/device/opencl/program.h"

namespace vat {

/// Returns the bytes that the steps of the solver `incompressible` need on the device.
std::size_t bytes_for_incompressible(const Model& model);

/// Returns the steps of an incompressible liquid, with the kernels of incompressible/step.cl and
/// solve.cl. The solves are those of core/liquid/incompressible/volume_solve.h. Throws
/// opencl::DeviceFailure.
std::unique_ptr<DeviceMethod> make_incompressible_method(opencl::Program& program,
                                                         std::shared_ptr<const Model> model);

}  // namespace vat
