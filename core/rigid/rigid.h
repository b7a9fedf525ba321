#pragma once

namespace vat {

struct StepContext;

/// Stage that moves the particles of rigid bodies to the poses of the bodies.
void pose_rigid_bodies(StepContext& context);

/// Stage that computes the resultant force and torque on each rigid body from the forces on its
/// particles (Boldt eqs. 5 and 6). The results are zero for held bodies.
void gather_rigid_forces(StepContext& context);

}  // namespace vat
