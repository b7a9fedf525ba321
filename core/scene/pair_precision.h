#pragma once

#include <cstdint>

namespace vat {

/// Floating-point precision of the sums over pairs in core/liquid/pairs. In single precision, the
/// relative error of motions is about 1e-7. The error of positions is about 1e-9 of the extent of
/// the scene. If the extent exceeds kMaxSupports support radii, sums use double precision. State
/// and integration always use double precision.
enum class PairPrecision : std::uint8_t { single_precision, double_precision };

inline constexpr double kMaxSupports = 1024;

}  // namespace vat
