#pragma once

#include "core/state/state.h"

namespace vat {

/// omega = I^-1 L with I = R I_body R^T. (Boldt eq. 7 prints the torque for L.)
Vec3 angular_velocity(const RigidModel& rigid, const Quat& orientation,
                      const Vec3& angular_momentum);

/// dq/dt = 1/2 (0, omega) q: Boldt eq. 8 for the quaternion.
Quat orientation_rate(const Quat& orientation, const Vec3& angular_velocity);

/// `orientation` turned for `dt` seconds of torque-free motion. Rotations about the principal axes,
/// composed to order four: stable and without energy drift for any ratio of the moments (rods and
/// plates are stiff), exact where two of them are equal; the angular momentum is not touched.
Quat rotate_freely(const RigidModel& rigid, const Quat& orientation, const Vec3& angular_momentum,
                   Real dt);

/// Positions and velocities of the body's particles from its pose.
void pose_rigid_body(const Model& model, const RigidModel& rigid, const RigidState& state,
                     Configuration& configuration);

}  // namespace vat
