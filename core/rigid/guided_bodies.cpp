#include "core/rigid/guided_bodies.h"

#include <cmath>

#include "core/laws/vat_motion.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {

void start_driven_bodies(const Model& model, Real start, Real end, Configuration& now) {
  VAT_CHECK(now.rigid.size() == model.rigid_bodies.size() && end > start);
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    if (!rigid.motion) continue;
    const Vec3 way =
        slide_motion(*rigid.motion, end).offset - slide_motion(*rigid.motion, start).offset;
    now.rigid[b].momentum = momentum_of(rigid, way / (end - start));
  }
}

void set_driven_velocities(const Model& model, Real time, Configuration& now) {
  VAT_CHECK(now.rigid.size() == model.rigid_bodies.size());
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    if (!rigid.motion) continue;
    now.rigid[b].momentum = momentum_of(rigid, slide_motion(*rigid.motion, time).velocity);
  }
}

void brake_axles(const Model& model, Real dt, Configuration& now) {
  VAT_CHECK(now.rigid.size() == model.rigid_bodies.size());
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    if (!rigid.axle || rigid.axle->damping == 0) continue;
    RigidState& state = now.rigid[b];
    const Vec3& axis = rigid.axle->direction;
    const Real mobility = axis.dot(angular_velocity(rigid, state.orientation, axis));
    state.angular_momentum *= std::exp(-rigid.axle->damping * mobility * dt);
  }
}

Real torque_on_axle(const RigidModel& rigid, const Vec3& outer_torque) {
  return rigid.axle ? rigid.axle->direction.dot(outer_torque) : 0;
}

}  // namespace vat
