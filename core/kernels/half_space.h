#pragma once

#include "core/types.h"

namespace vat {

/// Integrals of kernels over the half space beyond a wall at distance `d` from a liquid particle.
/// The integrals are the contributions of liquid in this half space to the particle's sums. In two
/// dimensions, the half space is the half plane beyond a line.
class HalfSpace {
 public:
  /// `h`: support radius of the kernels [m]; `dimensions`: 3 or 2.
  HalfSpace(Real h, int dimensions) : h_(h), dimensions_(dimensions) {}

  /// Returns the integral of the density kernel (Poly6): 1/2 for d <= 0, and 0 for d >= h.
  Real filling(Real d) const;

  /// Returns the integral of s/d times the Laplacian of the viscosity kernel [1/m^2]. s is the
  /// distance from the particle along the wall's normal. The factor s/d extrapolates the velocities
  /// of the particle and the wall linearly beyond the wall. Distances below kMinDistance h count as
  /// kMinDistance h in the divisor.
  Real drag(Real d) const;

  /// Minimum distance in drag(), in support radii. The drag grows as 1/d, and so does the decay
  /// rate of velocities. At the minimum distance, the drag of the wall is 1.5 times the drag of all
  /// neighbours of a particle deep in the liquid. Liquid at rest is half a spacing away from the
  /// wall. This distance exceeds the minimum if a support radius is at most five spacings.
  static constexpr Real kMinDistance = 0.1;

 private:
  Real h_;
  int dimensions_;
};

}  // namespace vat
