#pragma once

#include "core/kernels/kernel_id.h"
#include "core/types.h"

namespace vat {

/// A kernel W(r) = C w(q), q = r/h <= 1, for both the density and the pressure force of a liquid:
///
/// wendland_c2: w = (1 - q)^4 (1 + 4q), C = 21/(2 pi h^3) in three dimensions and 7/(pi h^2) in two
/// (H. Wendland, Adv. Comput. Math. 4 (1995) 389; its Fourier transform is positive, so that
/// particles do not pair: W. Dehnen, H. Aly, Mon. Not. R. Astron. Soc. 425 (2012) 1068).
///
/// cubic_spline: w = 1 - 6 q^2 (1 - q) up to q = 1/2 and 2 (1 - q)^3 beyond, C = 8/(pi h^3) and
/// 40/(7 pi h^2) (J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543); particles pair if a
/// support holds more than about 60.
class SmoothingKernel {
 public:
  /// `h`: support radius [m]; `dimensions`: 3 or 2; `scale`: factor of C.
  SmoothingKernel(KernelId id, Real h, int dimensions, Real scale = 1);

  KernelId id() const { return id_; }
  /// C, and slope_over_r() / g(q). g is (1 - q)^3 for wendland_c2. For cubic_spline it is 2 - 3q,
  /// and (1 - q)^2 / q from q = 1/2 on.
  Real scale() const { return scale_; }
  Real slope_scale() const { return slope_scale_; }

  /// W(r) for r <= h.
  Real value(Real r) const {
    const Real q = r * inverse_h_;
    const Real rest2 = (1 - q) * (1 - q);
    if (id_ == KernelId::cubic_spline) {
      return scale_ * (q < Real{0.5} ? 1 - 6 * q * q * (1 - q) : 2 * rest2 * (1 - q));
    }
    return scale_ * rest2 * rest2 * (1 + 4 * q);
  }
  /// dW/dr / r, which is finite at the centre. The gradient at x_ij is slope_over_r(|x_ij|) x_ij.
  Real slope_over_r(Real r) const {
    const Real q = r * inverse_h_;
    const Real rest = 1 - q;
    if (id_ == KernelId::cubic_spline) {
      return slope_scale_ * (q < Real{0.5} ? 2 - 3 * q : rest * rest / q);
    }
    return slope_scale_ * rest * rest * rest;
  }

 private:
  KernelId id_;
  Real inverse_h_;
  Real scale_;
  Real slope_scale_;
};

/// -sum_j V_j x dW/dx over the lattice of lattice_sum(): the slope that the kernel yields for a
/// unit slope along an axis.
Real lattice_slope(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions);

/// The sum of W over the points of a cubic (in two dimensions square) lattice around one of them,
/// times the volume of a cell: the density that the kernel yields for density 1.
Real lattice_sum(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions);

}  // namespace vat
