#include "core/forces/rigid.h"

#include "core/rigid/rigid_motion.h"
#include "core/step/workspace.h"

namespace vat {

void pose_rigid_bodies(StepContext& c) {
  for (std::size_t b = 0; b < c.model.rigid_bodies.size(); ++b) {
    pose_rigid_body(c.model, c.model.rigid_bodies[b], c.configuration.rigid[b], c.configuration);
  }
}

void gather_rigid_forces(StepContext& c) {
  for (std::size_t b = 0; b < c.model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = c.model.rigid_bodies[b];
    const Vec3 center = c.configuration.rigid[b].center_of_mass;
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    for (Index e = rigid.particles.begin; e < rigid.particles.end; ++e) {
      force += c.forces.particle[e];
      torque += (c.configuration.position[e] - center).cross(c.forces.particle[e]);
    }
    const bool is_held = rigid.is_held(c.step);
    c.forces.rigid_force[b] = is_held ? Vec3(Vec3::Zero()) : force;
    c.forces.rigid_torque[b] = is_held ? Vec3(Vec3::Zero()) : torque;
  }
}

}  // namespace vat
