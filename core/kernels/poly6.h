#pragma once

#include <numbers>

#include "core/types.h"

namespace vat {

/// W(r) = 315/(64 pi h^9) (h^2 - r^2)^3 for r <= h [MCG03] eq. 20; Boldt, section "Kernels".
class Poly6 {
 public:
  explicit Poly6(Real h)
      : h2_(h * h), scale_(315 / (64 * std::numbers::pi * h2_ * h2_ * h2_ * h2_ * h)) {}

  /// From the squared distance, which must be at most h^2.
  Real value(Real r2) const {
    const Real d = h2_ - r2;
    return scale_ * (d * d * d);
  }

 private:
  Real h2_;
  Real scale_;
};

}  // namespace vat
