#pragma once

#include "core/types.h"

namespace vat {

/// U(r) = W(r, H) - b W(r, H') of two particles that attract each other: of the energy
/// -A V_i V_j U. W is Wendland's C4 kernel, (1 - q)^6 (1 + 6q + 35/3 q^2) times 495/(32 pi H^3) in
/// space and 9/(pi H^2) in the plane (H. Wendland, Adv. Comput. Math. 4 (1995) 389), with H =
/// kReach h and H' = kCore h: far ones attract and near ones repel, and b, about 1, is such that
/// particles on a lattice neither pull nor press. Both parts are wide and smooth, so that it
/// matters little how the particles lie, and the near one's Fourier transform is above the far
/// one's everywhere, so that they do not pair.
class CohesionKernel {
 public:
  static constexpr Real kReach = 2;
  static constexpr Real kCore = 1.2;

  /// `support`: h [m]; `spacing`: of the lattice [m]; `dimensions`: 3 or 2.
  CohesionKernel(Real support, Real spacing, int dimensions);

  /// H [m].
  Real reach() const { return 1 / inverse_far_; }

  /// dU/dr / r, for r up to H and beyond; with `share` of the far part.
  Real slope_over_r(Real r, Real share = 1) const {
    return share * far_slope_ * shape(r * inverse_far_) + near_slope_ * shape(r * inverse_near_);
  }

  /// The integral of such a U over the plane (in two dimensions the line) at distance d >= 0: what
  /// the half space beyond d pulls with [1/m].
  Real over_plane(Real d, Real share) const;

  /// -sum_j V_j x dW/dx of the far part over the lattice, 1 at best.
  Real steepness() const { return steepness_; }

  /// w over the kernel's constant; the slope is -56/3 / H^2 times shape().
  static Real wendland_c4(Real q) {
    const Real rest = q < 1 ? 1 - q : 0;
    const Real rest2 = rest * rest;
    return rest2 * rest2 * rest2 * (1 + q * (6 + Real{35} / 3 * q));
  }

  /// The integral of W(r, 1) times the distance z from a plane over the half space z > 0: how much
  /// work it takes to part two half spaces, by reach.
  static Real first_moment(int dimensions);

 private:
  static Real shape(Real q) {
    const Real rest = q < 1 ? 1 - q : 0;
    const Real rest2 = rest * rest;
    return rest2 * rest2 * rest * (1 + 5 * q);
  }

  int dimensions_;
  Real inverse_far_;
  Real inverse_near_;
  Real far_scale_;
  Real near_scale_;
  Real far_slope_;
  Real near_slope_;
  Real steepness_;
};

}  // namespace vat
