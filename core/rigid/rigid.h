#pragma once

namespace vat {

struct StepContext;

/// Stage: moves the particles of rigid bodies to the poses.
void pose_rigid_bodies(StepContext& context);

/// Stage: computes resultant force and torque of the particles' forces, Boldt eqs. 5 and 6; zero
/// for held bodies.
void gather_rigid_forces(StepContext& context);

}  // namespace vat
