#pragma once

namespace vat {

/// The OpenCL C source of core/device/tait/step.cl.
extern const char* const kTaitKernels;

}  // namespace vat
