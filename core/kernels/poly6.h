#pragma once

#include <numbers>

#include "core/types.h"

namespace vat {

/// W(r) = C (h^2 - r^2)^3 for r <= h, in three dimensions with C = 315/(64 pi h^9) [MCG03] eq. 20;
/// Boldt, section "Kernels". In two, C = 4/(pi h^8) for a unit integral over the plane.
class Poly6 {
 public:
  /// `dimensions`: 3 or 2.
  explicit Poly6(Real h, int dimensions = 3)
      : h2_(h * h),
        scale_(dimensions == 3 ? 315 / (64 * std::numbers::pi * h2_ * h2_ * h2_ * h2_ * h)
                               : 4 / (std::numbers::pi * h2_ * h2_ * h2_ * h2_)) {}

  /// `r2`: squared distance, at most h^2.
  Real value(Real r2) const {
    const Real d = h2_ - r2;
    return scale_ * (d * d * d);
  }

 private:
  Real h2_;
  Real scale_;
};

}  // namespace vat
