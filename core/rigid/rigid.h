#pragma once

namespace vat {

struct StepContext;

/// Stage: particles of rigid bodies take their places from the poses.
void pose_rigid_bodies(StepContext& context);

/// Stage: resultant and torque of the particles' forces, Boldt eqs. 5 and 6; none on held bodies.
void gather_rigid_forces(StepContext& context);

}  // namespace vat
