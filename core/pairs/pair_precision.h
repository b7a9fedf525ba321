#pragma once

#include <cstdint>

namespace vat {

/// The floating-point numbers in which core/pairs sums: about a cluster of particles, places and
/// motions are exact to some 1e-7 or 1e-16 of their size. State and integration are double either
/// way.
enum class PairPrecision : std::uint8_t { single_precision, double_precision };

}  // namespace vat
