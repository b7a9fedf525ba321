#pragma once

#include "core/types.h"

namespace vat {

/// The coefficient of restitution e of a unilateral spring and dashpot, whose ends separate when
/// their force is zero, for the damping ratio zeta = c / (2 sqrt(k m)) (T. Schwager, T. Poeschel,
/// Granular Matter 9 (2007) 465). With s = sqrt(|1 - zeta^2|):
///
///   e = exp(-zeta/s (pi - atan2(2 zeta s, 1 - 2 zeta^2)))   for zeta < 1,
///   e = exp(-zeta/s ln((zeta + s) / (zeta - s)))            for zeta > 1.
Real restitution_of(Real damping_ratio);

/// The damping ratio for a restitution above 0 and at most 1.
Real damping_ratio_for(Real restitution);

/// The damping c [N s/m] of a contact with the stiffness k and the damping ratio zeta. A unit
/// impulse separates its ends with the speed `mobility` [1/kg], the inverse of their reduced mass.
/// Returns 0 if the mobility is 0.
Real damping_for(Real damping_ratio, Real stiffness, Real mobility);

}  // namespace vat
