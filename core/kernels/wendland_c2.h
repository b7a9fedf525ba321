#pragma once

#include "core/types.h"

namespace vat {

/// W(r) = C (1 - q)^4 (1 + 4q), q = r/h <= 1, with C = 21/(2 pi h^3) in three dimensions and
/// 7/(pi h^2) in two. (H. Wendland, Adv. Comput. Math. 4 (1995) 389; its Fourier transform is
/// positive, so that particles do not pair: W. Dehnen, H. Aly, Mon. Not. R. Astron. Soc. 425 (2012)
/// 1068.)
class WendlandC2 {
 public:
  /// `h`: support radius [m]; `dimensions`: 3 or 2; `scale`: of C.
  WendlandC2(Real h, int dimensions, Real scale = 1);

  Real value(Real r) const {
    const Real q = r * inverse_h_;
    const Real rest2 = (1 - q) * (1 - q);
    return scale_ * rest2 * rest2 * (1 + 4 * q);
  }
  /// dW/dr / r, which is finite at the centre; the gradient at x_ij is slope_over_r(|x_ij|) x_ij.
  Real slope_over_r(Real r) const {
    const Real rest = 1 - r * inverse_h_;
    return slope_scale_ * rest * rest * rest;
  }

 private:
  Real inverse_h_;
  Real scale_;
  Real slope_scale_;
};

/// -sum_j V_j x dW/dx over the same lattice: how steep the kernel takes a slope along an axis for.
Real lattice_slope(const WendlandC2& kernel, Real h, Real spacing, int dimensions);

/// The sum of W over the points of a cubic (in two dimensions square) lattice, seen from one of
/// them, times a cell's volume: how dense the kernel takes such a lattice for, 1 at best.
Real lattice_sum(const WendlandC2& kernel, Real h, Real spacing, int dimensions);

}  // namespace vat
