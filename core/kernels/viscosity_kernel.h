#pragma once

#include <cmath>
#include <numbers>

#include "core/types.h"

namespace vat {

/// The kernel whose Laplacian is C (h - r) for r <= h, zero with its slope at h. In three
/// dimensions W(r) = 15/(2 pi h^3) (-r^3/(2h^3) + r^2/h^2 + h/(2r) - 1), C = 45/(pi h^6) [MCG03]
/// eq. 22. Boldt prints 2h/r for h/(2r); only the latter has a unit integral, and a zero value and
/// slope at h. In two, W(r) = C (h r^2/4 - r^3/9 - 5h^3/36 - h^3/6 ln(r/h)), C = 40/(pi h^5).
class ViscosityKernel {
 public:
  /// `dimensions`: 3 or 2.
  explicit ViscosityKernel(Real h, int dimensions = 3)
      : h_(h),
        laplacian_scale_(dimensions == 3 ? 45 / (std::numbers::pi * h * h * h * h * h * h)
                                         : 40 / (std::numbers::pi * h * h * h * h * h)),
        dimensions_(dimensions) {}

  /// W(r) for r > 0.
  Real value(Real r) const {
    const Real q = r / h_;
    const Real h3 = h_ * h_ * h_;
    if (dimensions_ == 3) {
      return laplacian_scale_ * h3 / 6 * (-q * q * q / 2 + q * q + 1 / (2 * q) - 1);
    }
    return laplacian_scale_ * h3 * (q * q / 4 - q * q * q / 9 - Real{5} / 36 - std::log(q) / 6);
  }
  /// C (h - r), never negative: viscosity only slows relative motion.
  Real laplacian(Real r) const { return laplacian_scale_ * (h_ - r); }
  /// The constant C.
  Real laplacian_scale() const { return laplacian_scale_; }

 private:
  Real h_;
  Real laplacian_scale_;
  int dimensions_;
};

}  // namespace vat
