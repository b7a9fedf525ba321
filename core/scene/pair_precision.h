#pragma once

#include <cstdint>

namespace vat {

/// The floating-point precision of the sums of core/liquid/pairs. In single precision, the relative
/// error of motions is about 1e-7, and that of positions 1e-9 of their extent. If the extent
/// exceeds kMaxSupports support radii, sums use double precision. State and integration always use
/// double precision.
enum class PairPrecision : std::uint8_t { single_precision, double_precision };

inline constexpr double kMaxSupports = 1024;

}  // namespace vat
