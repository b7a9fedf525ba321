#include "core/rigid/rigid.h"

#include "core/contact/scratch.h"
#include "core/stage/context.h"
#include "core/state/rigid_motion.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {
namespace {

void find_spins(StepContext& c) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  contact_buffers.spins.clear();
  for (std::size_t b = 0; b < c.model.rigid_bodies.size(); ++b) {
    const RigidState& state = c.configuration.rigid[b];
    contact_buffers.spins.push_back(
        angular_velocity(c.model.rigid_bodies[b], state.orientation, state.angular_momentum));
  }
}

}  // namespace

void pose_rigid_bodies(StepContext& c) {
  if (c.model.has_friction) find_spins(c);
  for (std::size_t b = 0; b < c.model.rigid_bodies.size(); ++b) {
    pose_rigid_body(c.model, c.model.rigid_bodies[b], c.configuration.rigid[b], c.configuration);
  }
}

void gather_rigid_forces(StepContext& c) {
  VAT_CHECK(c.forces.rigid_force.size() == c.model.rigid_bodies.size() &&
            c.forces.particle.size() == c.model.particle_count);
  for (std::size_t b = 0; b < c.model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = c.model.rigid_bodies[b];
    const Vec3 center = c.configuration.rigid[b].center_of_mass;
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    for (Index e = rigid.particles.begin; e < rigid.particles.end; ++e) {
      force += c.forces.particle[e];
      torque += (c.configuration.position[e] - center).cross(c.forces.particle[e]);
    }
    if (c.model.has_friction) {
      for (Index e = rigid.particles.begin; e < rigid.particles.end; ++e) {
        torque += c.forces.friction_torque[e];
      }
    }
    const bool is_held = rigid.is_held(c.step);
    c.forces.rigid_force[b] = is_held ? Vec3(Vec3::Zero()) : force;
    c.forces.rigid_torque[b] = is_held ? Vec3(Vec3::Zero()) : torque;
    // Not before, because a reference to the sums would keep them in memory during the loops.
    apply_axle(rigid, c.forces.rigid_force[b], c.forces.rigid_torque[b]);
  }
}

}  // namespace vat
