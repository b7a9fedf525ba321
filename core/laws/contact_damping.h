#pragma once

#include "core/types.h"

namespace vat {

/// The coefficient of restitution e of the unilateral spring and dashpot, which part when their
/// force is zero, of damping ratio zeta = c / (2 sqrt(k m)) (T. Schwager, T. Poeschel, Granular
/// Matter 9 (2007) 465): with s = sqrt(|1 - zeta^2|),
///
///   e = exp(-zeta/s (pi - atan2(2 zeta s, 1 - 2 zeta^2)))   for zeta < 1,
///   e = exp(-zeta/s ln((zeta + s) / (zeta - s)))            for zeta > 1.
Real restitution_of(Real damping_ratio);

/// The damping ratio that has it; `restitution` above 0, at most 1.
Real damping_ratio_for(Real restitution);

/// c [N s/m] of a contact of `stiffness` k and damping ratio zeta between ends that a unit impulse
/// parts with the speed `mobility` [1/kg], the inverse of their reduced mass; 0 where nothing
/// moves.
Real damping_for(Real damping_ratio, Real stiffness, Real mobility);

}  // namespace vat
