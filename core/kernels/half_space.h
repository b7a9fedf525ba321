#pragma once

#include "core/types.h"

namespace vat {

/// Integrals of kernels over the half space beyond a wall at distance `d` from a liquid particle.
/// They are the contribution of liquid in this half space to the particle's sums. In two
/// dimensions, the integrals are over the half plane beyond a line.
class HalfSpace {
 public:
  /// `h`: support radius of the kernels [m]; `dimensions`: 3 or 2.
  HalfSpace(Real h, int dimensions) : h_(h), dimensions_(dimensions) {}

  /// The integral of the density kernel (Poly6): 1/2 at the wall, 0 from the support radius on. For
  /// d < 0, returns the value at the wall.
  Real filling(Real d) const;

  /// The integral of s/d times the Laplacian of the viscosity kernel [1/m^2], with s the distance
  /// from the particle along the wall's normal. The velocity beyond the wall is the linear
  /// extrapolation from the particle's velocity and the wall's velocity. The integral is constant
  /// for d < kMinDistance.
  Real drag(Real d) const;

  /// Minimum distance in support radii. The drag, and thus the decay rate of velocities, grows as
  /// 1/d. At this distance it is 1.5 times the drag of all neighbours of a particle deep in the
  /// liquid. Liquid at rest is further away: its distance is half a spacing, if a support radius
  /// has at most five spacings.
  static constexpr Real kMinDistance = 0.1;

 private:
  Real h_;
  int dimensions_;
};

}  // namespace vat
