#pragma once

#include "core/kernels/kernel_id.h"
#include "core/types.h"

namespace vat {

/// A kernel W(r) = C w(q) with q = r/h <= 1, for both the density and the pressure force of a
/// liquid.
///
/// The kernel wendland_c2 is w = (1 - q)^4 (1 + 4q), with C = 21/(2 pi h^3) in three dimensions and
/// C = 7/(pi h^2) in two dimensions (H. Wendland, Adv. Comput. Math. 4 (1995) 389). The Fourier
/// transform of this kernel is positive, so that particles do not pair (W. Dehnen, H. Aly, Mon.
/// Not. R. Astron. Soc. 425 (2012) 1068).
///
/// The kernel cubic_spline is w = 1 - 6 q^2 (1 - q) for q < 1/2 and w = 2 (1 - q)^3 for q >= 1/2,
/// with C = 8/(pi h^3) in three dimensions and C = 40/(7 pi h^2) in two dimensions (J. J. Monaghan,
/// Annu. Rev. Astron. Astrophys. 30 (1992) 543). With this kernel, particles pair if a particle has
/// more than about 60 neighbours within the support radius.
class SmoothingKernel {
 public:
  /// `h`: support radius [m]; `dimensions`: 3 or 2; `scale`: additional factor of C.
  SmoothingKernel(KernelId id, Real h, int dimensions, Real scale = 1);

  KernelId id() const { return id_; }
  /// scale() returns C. slope_scale() returns slope_over_r() / g(q). For wendland_c2, g is (1 -
  /// q)^3. For cubic_spline, g is 2 - 3q for q < 1/2, and (1 - q)^2 / q for q >= 1/2.
  Real scale() const { return scale_; }
  Real slope_scale() const { return slope_scale_; }

  /// Returns W(r) for r <= h.
  Real value(Real r) const {
    const Real q = r * inverse_h_;
    const Real rest2 = (1 - q) * (1 - q);
    if (id_ == KernelId::cubic_spline) {
      return scale_ * (q < Real{0.5} ? 1 - 6 * q * q * (1 - q) : 2 * rest2 * (1 - q));
    }
    return scale_ * rest2 * rest2 * (1 + 4 * q);
  }
  /// Returns dW/dr / r for r <= h. This quotient is finite at r = 0. The gradient at x_ij is
  /// slope_over_r(|x_ij|) x_ij.
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

/// Returns -sum_j V_j x dW/dx over the lattice of lattice_sum(). This sum is the SPH estimate of
/// the slope of a field with slope 1 along an axis.
Real lattice_slope(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions);

/// Returns the sum of W times the cell volume over a cubic lattice (in two dimensions a square
/// lattice) around one of its points. This sum is the SPH estimate of a density of 1.
Real lattice_sum(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions);

}  // namespace vat
