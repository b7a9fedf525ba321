#pragma once

#include "core/state/state.h"

namespace vat {

/// Returns omega = I^-1 L [rad/s], with I = R I_body R^T. (Boldt eq. 7 prints the torque in place
/// of L.)
Vec3 angular_velocity(const RigidModel& rigid, const Quat& orientation,
                      const Vec3& angular_momentum);

/// Returns the momentum of a body whose centre of mass has this velocity; zero with an axle.
Vec3 momentum_of(const RigidModel& rigid, const Vec3& velocity);
/// Returns the angular momentum L = I omega; with an axle, the part of L along the axle.
Vec3 angular_momentum_of(const RigidModel& rigid, const Quat& orientation, const Vec3& omega);

/// Sets the parts of a force and a torque to zero that the body's axle absorbs, if it has one.
void apply_axle(const RigidModel& rigid, Vec3& force, Vec3& torque);

/// Returns dq/dt = 1/2 (0, omega) q, Boldt eq. 8 in the form for a quaternion q.
Quat orientation_rate(const Quat& orientation, const Vec3& angular_velocity);

/// Returns `orientation` after `dt` seconds of motion without torque. The method composes rotations
/// about the principal axes with order 4. The result is stable and has no energy drift for all
/// ratios of the moments of inertia, such as those of rods and plates. The result is exact if two
/// moments of inertia are equal.
Quat rotate_freely(const RigidModel& rigid, const Quat& orientation, const Vec3& angular_momentum,
                   Real dt);

/// Sets the positions and velocities of the particles of `rigid` to those of the rigid motion
/// `state`.
void pose_rigid_body(const Model& model, const RigidModel& rigid, const RigidState& state,
                     Configuration& configuration);

/// Returns the greatest inverse mass that a force on a particle moves in the nominal step `step`:
/// 1/m of a free particle, 1/M + |x|^2 / I of a particle of a rigid body, 0 if the body is held
/// [1/kg]. The force acts at most `distance` [m] from the centre of the particle.
Real greatest_inverse_mass(const Model& model, Index particle, std::uint64_t step,
                           Real distance = 0);

}  // namespace vat
