#pragma once

#include <numbers>

#include "core/types.h"

namespace vat {

/// W(r) = C (h - r)^3 for r <= h, in three dimensions with C = 15/(pi h^6) [MCG03] eq. 21 after
/// [DC96]; in two, C = 10/(pi h^5) for a unit integral over the plane. Its gradient does not vanish
/// at the centre, so pressure keeps particles apart.
class Spiky {
 public:
  /// `dimensions`: 3 or 2.
  explicit Spiky(Real h, int dimensions = 3)
      : h_(h),
        scale_(dimensions == 3 ? 15 / (std::numbers::pi * h * h * h * h * h * h)
                               : 10 / (std::numbers::pi * h * h * h * h * h)) {}

  Real value(Real r) const {
    const Real d = h_ - r;
    return scale_ * (d * d * d);
  }
  /// dW/dr, negative; the gradient at x_ij is slope(|x_ij|) x_ij / |x_ij|.
  Real slope(Real r) const {
    const Real d = h_ - r;
    return -3 * scale_ * (d * d);
  }

 private:
  Real h_;
  Real scale_;
};

}  // namespace vat
