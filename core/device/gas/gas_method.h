#pragma once

#include <cstddef>
#include <memory>

#include "core/device/common/device_method.h"
#include "core/device/opencl/program.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// Returns the bytes of the buffers of make_gas_method().
std::size_t bytes_for_gas(const Model& model);

/// Creates the steps of a model with liquids of the solver `gas`. Throws opencl::DeviceFailure.
std::unique_ptr<DeviceMethod> make_gas_method(opencl::Program& program,
                                              std::shared_ptr<const Model> model,
                                              const GuardBounds& bounds);

}  // namespace vat
