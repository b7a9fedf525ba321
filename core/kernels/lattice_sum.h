#pragma once

#include <cmath>

#include "core/types.h"

namespace vat {

/// Returns a sum over a cubic lattice (in two dimensions a square lattice). The terms are f(x, r)
/// times the cell volume, for all points within the distance h of one lattice point, including this
/// point. r is the distance from the lattice point, and x is the component of the offset along an
/// axis.
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
