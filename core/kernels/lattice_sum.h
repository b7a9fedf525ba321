#pragma once

#include <cmath>

#include "core/types.h"

namespace vat {

/// The sum of f(x, r), times the volume of a cell, over the points of a cubic (in two dimensions
/// square) lattice that are closer than h to one of its points. r is the distance from this point,
/// and x its component along an axis.
template <class F>
Real sum_over_lattice(Real h, Real spacing, int dimensions, F&& f) {
  const int reach = static_cast<int>(h / spacing);
  const int depth = dimensions == 3 ? reach : 0;
  Real sum = 0;
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -depth; y <= depth; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Real r = spacing * std::sqrt(static_cast<Real>(x * x + y * y + z * z));
        if (r < h) sum += f(spacing * static_cast<Real>(x), r);
      }
    }
  }
  return sum * std::pow(spacing, dimensions);
}

}  // namespace vat
