#pragma once

#include <numbers>

#include "core/types.h"

namespace vat {

/// W(r) = 15/(pi h^6) (h - r)^3 for r <= h [MCG03] eq. 21 after [DC96]. Its gradient does not
/// vanish at the centre, so pressure keeps particles apart.
class Spiky {
 public:
  explicit Spiky(Real h) : h_(h), scale_(15 / (std::numbers::pi * h * h * h * h * h * h)) {}

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
