#pragma once

#include "core/model/model.h"
#include "core/state/state.h"

/// Rigid bodies whose motion the scene prescribes in part: driven bodies and bodies with axles.
namespace vat {

/// Gives each driven body the mean velocity of its motion from `start` to `end` [s]. With this
/// velocity, a step moves the body by exactly the way of its motion.
void start_driven_bodies(const Model& model, Real start, Real end, Configuration& now);

/// Gives each driven body the velocity of its motion at `time` [s].
void set_driven_velocities(const Model& model, Real time, Configuration& now);

/// Applies the brakes of axles for `dt` [s], with the exact decay of the angular velocity.
void brake_axles(const Model& model, Real dt, Configuration& now);

/// Returns the torque of `outer_torque` about the axle of a body [N m]; 0 without an axle.
Real torque_on_axle(const RigidModel& rigid, const Vec3& outer_torque);

}  // namespace vat
