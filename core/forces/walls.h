#pragma once

#include "core/forces/vat_motion.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stage: the vat's walls push on particles nearer than their threshold by a unilateral spring and
/// dashpot, as a dynamic connection to the nearest point of the wall would, and rub on them by the
/// friction of core/forces/friction.h.
void add_wall_forces(StepContext& context);

/// The walls' force on particle i [N], where none has a restitution.
Vec3 wall_force(const Model& model, const VatMotion& motion, const Configuration& at, Index i);

/// How fast something of this velocity slips along the wall's surface [m/s].
Vec3 wall_slip(const Vat& vat, const VatMotion& motion, int wall, const Vec3& velocity);

}  // namespace vat
