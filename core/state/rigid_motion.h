#pragma once

#include "core/state/state.h"

namespace vat {

/// omega = I^-1 L with I = R I_body R^T. (Boldt eq. 7 prints the torque in place of L.)
Vec3 angular_velocity(const RigidModel& rigid, const Quat& orientation,
                      const Vec3& angular_momentum);

/// dq/dt = 1/2 (0, omega) q: Boldt eq. 8 for the quaternion.
Quat orientation_rate(const Quat& orientation, const Vec3& angular_velocity);

/// `orientation` after `dt` seconds of motion without torque. The rotations about the principal
/// axes are composed with order four. The result is stable and without energy drift for all ratios
/// of the moments (rods and plates are stiff), and exact if two moments are equal.
Quat rotate_freely(const RigidModel& rigid, const Quat& orientation, const Vec3& angular_momentum,
                   Real dt);

/// Sets positions and velocities of the body's particles from its pose.
void pose_rigid_body(const Model& model, const RigidModel& rigid, const RigidState& state,
                     Configuration& configuration);

}  // namespace vat
