#pragma once

#include "core/kernels/cohesion_kernel.h"
#include "core/support/check.h"
#include "core/types.h"

namespace vat {

/// Constants of surface tension by curvature, derived in core/liquid/surface/surface_tension.h.
inline constexpr double kSurfaceThreshold = 0.6;
inline constexpr double kCohesion = 4;
inline constexpr double kSurfaceDepth = 0.34;
inline constexpr double kSurfaceBulge = 0.105;

/// Constants of the cohesion of liquids, derived in core/liquid/surface/cohesion.h.
inline constexpr Real kTensileShare = 0.4;
inline constexpr Real kRelaxation = 1.52;

/// Returns the attraction A [Pa] of a liquid with `surface_tension` [N/m] and `support_radius` [m].
inline Real attraction_of(Real surface_tension, Real support_radius, int dimensions) {
  VAT_CHECK(support_radius > 0);
  const Real moment = CohesionKernel::first_moment(dimensions) *
                      (CohesionKernel::kReach - CohesionKernel::kCore) * support_radius;
  return 2 * surface_tension / (kRelaxation * moment);
}

/// Returns the attraction by a wall relative to the attraction by the liquid, for the cosine of the
/// contact angle.
inline Real adhesion_share(Real cosine) {
  return 0.796 + cosine * (0.321 - 0.021 * cosine);
}

}  // namespace vat
