#pragma once

#include "core/types.h"

namespace vat {

/// Returns the coefficient of restitution e of an impact with a unilateral spring and dashpot, for
/// the damping ratio zeta = c / (2 sqrt(k m)) (T. Schwager, T. Poeschel, Granular Matter 9 (2007)
/// 465). The impact ends when the force is zero. With s = sqrt(|1 - zeta^2|):
///
///   e = exp(-zeta/s (pi - atan2(2 zeta s, 1 - 2 zeta^2)))   for zeta < 1,
///   e = exp(-zeta/s ln((zeta + s) / (zeta - s)))            for zeta > 1.
Real restitution_of(Real damping_ratio);

/// Returns the damping ratio for a coefficient of restitution in (0, 1].
Real damping_ratio_for(Real restitution);

/// Returns the damping c [N s/m] of a contact with the stiffness k [N/m] and the damping ratio
/// zeta. `mobility` [1/kg] is the separation speed of the two ends after a unit impulse, which is
/// the inverse of their reduced mass. Returns 0 if the mobility is 0.
Real damping_for(Real damping_ratio, Real stiffness, Real mobility);

}  // namespace vat
