#pragma once

#include "core/laws/vat_motion.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stage: the vat's walls push on particles nearer than their threshold by a unilateral spring and
/// dashpot, as a dynamic connection to the nearest point of the wall would, and rub on them by the
/// friction of core/laws/friction.h.
void add_wall_forces(StepContext& context);

/// On one particle.
struct ContactForce {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< of friction, about the particle's centre [N m]
};

/// What the walls do to particle i, where none has a restitution; `spins` are by rigid body
/// [rad/s].
ContactForce wall_force(const Model& model, const VatMotion& motion, const Configuration& at,
                        const std::vector<Vec3>& spins, Index i);

/// From particle i, `distance` from the wall, to where they rub [m].
Vec3 wall_arm(const Model& model, Index i, int wall, Real distance);

/// How fast something of this velocity slips along the wall's surface [m/s].
Vec3 wall_slip(const Vat& vat, const VatMotion& motion, int wall, const Vec3& velocity);

}  // namespace vat
