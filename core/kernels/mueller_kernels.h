#pragma once

#include <cmath>
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

/// The kernel with the Laplacian C (h - r) for r <= h; its value and its slope are zero at h. In
/// three dimensions W(r) = 15/(2 pi h^3) (-r^3/(2h^3) + r^2/h^2 + h/(2r) - 1), C = 45/(pi h^6)
/// [MCG03] eq. 22. Boldt prints 2h/r for h/(2r); only the latter has a unit integral, and a zero
/// value and slope at h. In two, W(r) = C (h r^2/4 - r^3/9 - 5h^3/36 - h^3/6 ln(r/h)), C = 40/(pi
/// h^5).
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
