#pragma once

namespace vat {

/// The OpenCL C sources of the folders of core/device, in the order of core/CMakeLists.txt.
extern const char* const kDeviceKernels;

}  // namespace vat
