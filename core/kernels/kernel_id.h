#pragma once

#include <cstdint>

namespace vat {

/// Identifiers of the kernels in core/kernels/smoothing_kernel.h.
enum class KernelId : std::uint8_t { wendland_c2, cubic_spline };

}  // namespace vat
