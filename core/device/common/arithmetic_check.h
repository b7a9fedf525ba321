#pragma once

#include <span>
#include <vector>

#include "core/device/opencl/program.h"

namespace vat {

/// Returns the results that a device with exact arithmetic must have in the kernel
/// test_arithmetic, computed by the CPU.
std::vector<double> exact_arithmetic();

/// Fails with the code "not_available" if a result differs from exact_arithmetic(), which has the
/// same size. The message names the operation and the driver.
Status check_arithmetic(const opencl::Device& device, std::span<const double> results);

/// Runs this kernel and checks its results. Drivers can have incorrect rounding although they
/// promise the correct one. Throws opencl::DeviceFailure.
Status test_arithmetic(opencl::Program& program);

}  // namespace vat
