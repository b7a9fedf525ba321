#pragma once

#include <cstdint>

namespace vat {

/// The floating-point numbers in which core/pairs sums. In single precision motions are exact to
/// some 1e-7 of their size, and places to 1e-9 of the span of all of them: where these are further
/// apart than kMaxSupports support radii, sums are in double precision. State and integration are
/// double either way.
enum class PairPrecision : std::uint8_t { single_precision, double_precision };

inline constexpr double kMaxSupports = 1024;

}  // namespace vat
