#pragma once

#include "core/types.h"

namespace vat {

/// Two cohesive particles at the distance r have the energy -A V_i V_j U(r), with the attraction A
/// [Pa] and the volumes V_i and V_j. U(r) = W(r, H) - b W(r, H'). W is Wendland's C4 kernel (1
/// - q)^6 (1 + 6q + 35/3 q^2) times 495/(32 pi H^3) in space and 9/(pi H^2) in the plane (H.
/// Wendland, Adv. Comput. Math. 4 (1995) 389). The far part W(r, H) has the support radius H =
/// kReach h, and the near part W(r, H') has H' = kCore h. Distant particles attract each other, and
/// near particles repel each other. The factor b, about 1, is chosen so that particles on a lattice
/// exert no pressure. Both parts are wide and smooth, so that the arrangement of the particles has
/// little influence. The Fourier transform of the near part exceeds that of the far part at all
/// wave numbers, so that particles do not pair.
class CohesionKernel {
 public:
  static constexpr Real kReach = 2;
  static constexpr Real kCore = 1.2;

  /// `support`: support radius h [m]; `spacing`: spacing of the lattice [m]; `dimensions`: 3 or 2.
  CohesionKernel(Real support, Real spacing, int dimensions);

  /// Returns the support radius H of the far part [m].
  Real reach() const { return 1 / inverse_far_; }

  /// Returns dU/dr / r for any r >= 0. `share` scales the far part.
  Real slope_over_r(Real r, Real share = 1) const {
    return share * far_slope_ * shape(r * inverse_far_) + near_slope_ * shape(r * inverse_near_);
  }

  /// Returns the integral of U over a plane (in two dimensions a line) at the distance d >= 0
  /// [1/m]. This integral is the attraction by the half space beyond the plane. `share` scales the
  /// far part.
  Real over_plane(Real d, Real share) const;

  /// Returns -sum_j V_j x dW/dx of the far part over the lattice; the ideal value is 1.
  Real steepness() const { return steepness_; }

  /// Returns W without its constant factor. dw/dr / r is -56/3 / H^2 times shape().
  static Real wendland_c4(Real q) {
    const Real rest = q < 1 ? 1 - q : 0;
    const Real rest2 = rest * rest;
    return rest2 * rest2 * rest2 * (1 + q * (6 + Real{35} / 3 * q));
  }

  /// Returns the integral of z W(r, 1) over the half space z > 0, with the distance z from its
  /// plane. This integral is the work of separating two half spaces, in units of the support
  /// radius.
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
