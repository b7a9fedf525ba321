#pragma once

#include "core/types.h"

namespace vat {

/// Kernels integrated over the half space beyond a wall, seen from a particle of liquid at distance
/// `d` from it: what a liquid that filled all of the space there would add to the particle's sums.
/// In two dimensions, the half plane beyond a line.
class HalfSpace {
 public:
  /// `h`: support radius of the kernels [m]; `dimensions`: 3 or 2.
  HalfSpace(Real h, int dimensions) : h_(h), dimensions_(dimensions) {}

  /// Integral of the kernel of the density (Poly6): 1/2 at the wall, 0 from the support radius on;
  /// for d < 0, that at the wall.
  Real filling(Real d) const;

  /// Integral of s/d times the Laplacian of the viscosity kernel, s the distance from the particle
  /// along the wall's normal [1/m^2]: for a liquid whose velocity goes on beyond the wall on the
  /// straight line from the particle's to the wall's. Nearer than kMinDistance it grows no more.
  Real drag(Real d) const;

  /// Of the support radius. The drag grows as 1/d, and with it the rate at which a velocity decays;
  /// here that is one and a half times what all its neighbours do to a particle deep in the liquid.
  /// A liquid at rest stays further away: half a spacing, with at most five spacings to a support.
  static constexpr Real kMinDistance = 0.1;

 private:
  Real h_;
  int dimensions_;
};

}  // namespace vat
