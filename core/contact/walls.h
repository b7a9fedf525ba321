#pragma once

#include "core/laws/vat_motion.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stage that adds the forces of the vat's walls on particles. A wall acts on particles closer than
/// their threshold, by a unilateral spring and dashpot along the wall's normal. Adhesive layers and
/// friction follow core/laws/lennard_jones.h and core/laws/friction.h.
void add_wall_forces(StepContext& context);

/// The force and torque of contacts on one particle.
struct ContactForce {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< torque of friction about the particle's centre [N m]
};

/// Returns the force of the walls on particle i, for walls without restitution. `spins` are the
/// angular velocities of the rigid bodies [rad/s].
ContactForce wall_force(const Model& model, const VatMotion& motion, const Configuration& at,
                        const std::vector<Vec3>& spins, Index i);

/// Returns the vector from the centre of particle i to its friction point at a wall at `distance`
/// [m].
Vec3 wall_arm(const Model& model, Index i, int wall, Real distance);

/// Returns the slip along a wall of a point with `velocity` [m/s].
Vec3 wall_slip(const Vat& vat, const VatMotion& motion, int wall, const Vec3& velocity);

}  // namespace vat
