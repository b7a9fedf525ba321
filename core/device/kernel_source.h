#pragma once

#include <string>

namespace vat {

/// Returns the OpenCL C sources of the folders of core/device, in the order of core/CMakeLists.txt.
std::string device_kernels();

}  // namespace vat
