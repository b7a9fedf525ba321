#pragma once

#include "core/laws/vat_motion.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stage: adds the forces of the vat's walls on particles within their threshold: a unilateral
/// spring and dashpot to the nearest point of the wall, and the friction of core/laws/friction.h.
void add_wall_forces(StepContext& context);

/// Force of contacts on one particle.
struct ContactForce {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< of friction, about the particle's centre [N m]
};

/// The force of the walls on particle i, for walls without restitution. `spins` are by rigid body
/// [rad/s].
ContactForce wall_force(const Model& model, const VatMotion& motion, const Configuration& at,
                        const std::vector<Vec3>& spins, Index i);

/// The vector from particle i, at `distance` from the wall, to the point of friction [m].
Vec3 wall_arm(const Model& model, Index i, int wall, Real distance);

/// The slip of a point with this velocity along the surface of the wall [m/s].
Vec3 wall_slip(const Vat& vat, const VatMotion& motion, int wall, const Vec3& velocity);

}  // namespace vat
