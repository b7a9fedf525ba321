#pragma once

#include "core/types.h"

namespace vat {

/// U(r) = W(r, H) - b W(r, H') of two cohesive particles, for the energy -A V_i V_j U. W is
/// Wendland's C4 kernel, (1 - q)^6 (1 + 6q + 35/3 q^2) times 495/(32 pi H^3) in space and 9/(pi
/// H^2) in the plane (H. Wendland, Adv. Comput. Math. 4 (1995) 389), with H = kReach h and H' =
/// kCore h. Distant particles attract and near ones repel each other. b, about 1, is chosen so that
/// particles on a lattice exert no pressure. Both parts are wide and smooth, so that the positions
/// of particles have little influence. The Fourier transform of the near part is above that of the
/// far part everywhere, so that particles do not pair.
class CohesionKernel {
 public:
  static constexpr Real kReach = 2;
  static constexpr Real kCore = 1.2;

  /// `support`: h [m]; `spacing`: of the lattice [m]; `dimensions`: 3 or 2.
  CohesionKernel(Real support, Real spacing, int dimensions);

  /// H [m].
  Real reach() const { return 1 / inverse_far_; }

  /// dU/dr / r, for all r; `share` scales the far part.
  Real slope_over_r(Real r, Real share = 1) const {
    return share * far_slope_ * shape(r * inverse_far_) + near_slope_ * shape(r * inverse_near_);
  }

  /// The integral of U over the plane (in two dimensions the line) at distance d >= 0: the pull of
  /// the half space beyond d [1/m]. `share` scales the far part.
  Real over_plane(Real d, Real share) const;

  /// -sum_j V_j x dW/dx of the far part over the lattice; ideally 1.
  Real steepness() const { return steepness_; }

  /// w without the constant of the kernel. Its slope is -56/3 / H^2 times shape().
  static Real wendland_c4(Real q) {
    const Real rest = q < 1 ? 1 - q : 0;
    const Real rest2 = rest * rest;
    return rest2 * rest2 * rest2 * (1 + q * (6 + Real{35} / 3 * q));
  }

  /// The integral of W(r, 1) times the distance z from a plane over the half space z > 0: the work
  /// of separating two half spaces, in units of the reach.
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
