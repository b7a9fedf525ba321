#pragma once

#include "core/types.h"

namespace vat {

/// Integrals of kernels over the half space beyond a wall, at distance `d` from a liquid particle:
/// the share of a liquid that fills this half space in the sums of the particle. In two dimensions,
/// over the half plane beyond a line.
class HalfSpace {
 public:
  /// `h`: support radius of the kernels [m]; `dimensions`: 3 or 2.
  HalfSpace(Real h, int dimensions) : h_(h), dimensions_(dimensions) {}

  /// The integral of the density kernel (Poly6): 1/2 at the wall, 0 from the support radius on. For
  /// d < 0, the value at the wall.
  Real filling(Real d) const;

  /// The integral of s/d times the Laplacian of the viscosity kernel [1/m^2], with s the distance
  /// from the particle along the wall's normal. The velocity of the liquid beyond the wall
  /// continues the line from the particle's velocity to the wall's. Constant below kMinDistance.
  Real drag(Real d) const;

  /// In support radii. The drag grows as 1/d, and with it the decay rate of a velocity. At this
  /// distance it is 1.5 times the drag of all neighbours of a particle deep in the liquid. Liquid
  /// at rest stays further away: half a spacing, with at most five spacings in a support radius.
  static constexpr Real kMinDistance = 0.1;

 private:
  Real h_;
  int dimensions_;
};

}  // namespace vat
