#pragma once

#include "core/forces/vat_motion.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stage: the vat's walls push on particles nearer than their threshold by a unilateral spring and
/// dashpot, as a dynamic connection to the nearest point of the wall would.
void add_wall_forces(StepContext& context);

/// The walls' force on particle i [N].
Vec3 wall_force(const Model& model, const VatMotion& motion, const Configuration& at, Index i);

}  // namespace vat
