#pragma once

#include <cstdint>

#include "core/types.h"

namespace vat {

/// Returns a unit vector for two particles at the same position, for which x_ij / |x_ij| is
/// undefined. The vector is a hash of the pair, and therefore equal in all runs. The vector of (j,
/// i) is opposite to that of (i, j). In two dimensions, the vector is in the plane y = 0.
inline Vec3 coincident_direction(Index i, Index j, int dimensions = 3) {
  const Index low = i < j ? i : j;
  const Index high = i < j ? j : i;
  std::uint64_t bits = (std::uint64_t{low} << 32 | high) * 0x9e3779b97f4a7c15ULL;
  Vec3 direction;
  for (int axis = 0; axis < 3; ++axis) {
    bits ^= bits >> 29;
    bits *= 0xbf58476d1ce4e5b9ULL;
    direction[axis] = static_cast<Real>(bits >> 40) - 0x1p23 + 0.5;  // never zero
  }
  if (dimensions == 2) direction.y() = 0;
  direction.normalize();
  return i < j ? direction : Vec3(-direction);
}

/// Returns x_ij / r, or coincident_direction() for r = 0.
inline Vec3 pair_direction(const Vec3& x_ij, Real r, Index i, Index j, int dimensions = 3) {
  return r > 0 ? Vec3(x_ij / r) : coincident_direction(i, j, dimensions);
}

}  // namespace vat
