#pragma once

#include <numbers>

#include "core/types.h"

namespace vat {

/// W(r) = 15/(2 pi h^3) (-r^3/(2h^3) + r^2/h^2 + h/(2r) - 1) for r <= h [MCG03] eq. 22. Boldt
/// prints 2h/r for h/(2r); only the latter has unit integral and a zero value and slope at h.
class ViscosityKernel {
 public:
  explicit ViscosityKernel(Real h)
      : h_(h),
        scale_(15 / (2 * std::numbers::pi * h * h * h)),
        laplacian_scale_(45 / (std::numbers::pi * h * h * h * h * h * h)) {}

  /// r > 0.
  Real value(Real r) const {
    const Real q = r / h_;
    return scale_ * (-q * q * q / 2 + q * q + 1 / (2 * q) - 1);
  }
  /// 45/(pi h^6) (h - r), never negative: viscosity only ever slows relative motion.
  Real laplacian(Real r) const { return laplacian_scale_ * (h_ - r); }

 private:
  Real h_;
  Real scale_;
  Real laplacian_scale_;
};

}  // namespace vat
