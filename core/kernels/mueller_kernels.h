#pragma once

#include <cmath>
#include <numbers>

#include "core/types.h"

namespace vat {

/// The density kernel W(r) = C (h^2 - r^2)^3 for r <= h ([MCG03] eq. 20; Boldt, section "Kernels").
/// In three dimensions, C = 315/(64 pi h^9). In two dimensions, C = 4/(pi h^8), so that the
/// integral over the plane is 1.
class Poly6 {
 public:
  /// `dimensions`: 3 or 2.
  explicit Poly6(Real h, int dimensions = 3)
      : h2_(h * h),
        scale_(dimensions == 3 ? 315 / (64 * std::numbers::pi * h2_ * h2_ * h2_ * h2_ * h)
                               : 4 / (std::numbers::pi * h2_ * h2_ * h2_ * h2_)) {}

  /// Returns W for the squared distance `r2` <= h^2.
  Real value(Real r2) const {
    const Real d = h2_ - r2;
    return scale_ * (d * d * d);
  }

 private:
  Real h2_;
  Real scale_;
};

/// The pressure kernel W(r) = C (h - r)^3 for r <= h ([MCG03] eq. 21 after [DC96]). In three
/// dimensions, C = 15/(pi h^6). In two dimensions, C = 10/(pi h^5), so that the integral over the
/// plane is 1. The gradient does not vanish at the centre, so that pressure separates close
/// particles.
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
  /// Returns dW/dr <= 0. The gradient at x_ij is slope(|x_ij|) x_ij / |x_ij|.
  Real slope(Real r) const {
    const Real d = h_ - r;
    return -3 * scale_ * (d * d);
  }

 private:
  Real h_;
  Real scale_;
};

/// The viscosity kernel, with the Laplacian C (h - r) for r <= h, and with value and slope 0 at h.
/// In three dimensions, W(r) = 15/(2 pi h^3) (-r^3/(2h^3) + r^2/h^2 + h/(2r) - 1) with C = 45/(pi
/// h^6) ([MCG03] eq. 22). Boldt prints 2h/r instead of h/(2r). With 2h/r, the integral would not be
/// 1, and the value and slope at h would not be 0. In two dimensions, W(r) = C (h r^2/4 - r^3/9 -
/// 5h^3/36 - h^3/6 ln(r/h)) with C = 40/(pi h^5).
class ViscosityKernel {
 public:
  /// `dimensions`: 3 or 2.
  explicit ViscosityKernel(Real h, int dimensions = 3)
      : h_(h),
        laplacian_scale_(dimensions == 3 ? 45 / (std::numbers::pi * h * h * h * h * h * h)
                                         : 40 / (std::numbers::pi * h * h * h * h * h)),
        dimensions_(dimensions) {}

  /// Returns W(r) for 0 < r <= h.
  Real value(Real r) const {
    const Real q = r / h_;
    const Real h3 = h_ * h_ * h_;
    if (dimensions_ == 3) {
      return laplacian_scale_ * h3 / 6 * (-q * q * q / 2 + q * q + 1 / (2 * q) - 1);
    }
    return laplacian_scale_ * h3 * (q * q / 4 - q * q * q / 9 - Real{5} / 36 - std::log(q) / 6);
  }
  /// Returns the Laplacian C (h - r) for r <= h. The Laplacian is not negative, so that viscosity
  /// never accelerates relative motion.
  Real laplacian(Real r) const { return laplacian_scale_ * (h_ - r); }
  /// Returns the constant C.
  Real laplacian_scale() const { return laplacian_scale_; }

 private:
  Real h_;
  Real laplacian_scale_;
  int dimensions_;
};

}  // namespace vat
