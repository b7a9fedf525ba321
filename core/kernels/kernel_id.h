#pragma once

#include <cstdint>

namespace vat {

/// The kernels that core/kernels/smoothing_kernel.h has.
enum class KernelId : std::uint8_t { wendland_c2, cubic_spline };

}  // namespace vat
