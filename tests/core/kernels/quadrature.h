#pragma once

#include <cmath>

#include "core/types.h"

namespace vat::test {

/// Returns the integral of f over [from, to] by composite three-point Gauss-Legendre quadrature in
/// sqrt(r - from). The substitution removes logarithms and roots at `from`.
template <class F>
Real integrate(Real from, Real to, F&& f) {
  constexpr int kPieces = 2000;
  const Real offset = std::sqrt(3.0 / 5);
  const Real half = 0.5 / kPieces;
  const auto at = [&](Real t) { return f(from + (to - from) * t * t) * 2 * (to - from) * t; };
  Real sum = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const Real middle = (2 * piece + 1) * half;
    sum += half / 9 *
           (5 * at(middle - offset * half) + 8 * at(middle) + 5 * at(middle + offset * half));
  }
  return sum;
}

}  // namespace vat::test
