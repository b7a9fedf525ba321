#include "core/rigid/rigid_motion.h"

namespace vat {
namespace {

Quat add_scaled(const Quat& q, Real scale, const Quat& rate) {
  return Quat(Quat::Coefficients(q.coeffs() + scale * rate.coeffs()));
}

}  // namespace

Vec3 angular_velocity(const RigidModel& rigid, const Quat& orientation,
                      const Vec3& angular_momentum) {
  const Mat3 r = orientation.normalized().toRotationMatrix();
  return r * (rigid.inverse_inertia * (r.transpose() * angular_momentum));
}

Quat orientation_rate(const Quat& orientation, const Vec3& angular_velocity) {
  const Quat omega(0, angular_velocity.x(), angular_velocity.y(), angular_velocity.z());
  const Quat product = omega * orientation;
  return Quat(Quat::Coefficients(0.5 * product.coeffs()));
}

Quat rotate_freely(const RigidModel& rigid, const Quat& orientation, const Vec3& angular_momentum,
                   Real dt) {
  const auto rate = [&](const Quat& q) {
    return orientation_rate(q, angular_velocity(rigid, q, angular_momentum));
  };
  const Quat k1 = rate(orientation);
  const Quat k2 = rate(add_scaled(orientation, dt / 2, k1));
  const Quat k3 = rate(add_scaled(orientation, dt / 2, k2));
  const Quat k4 = rate(add_scaled(orientation, dt, k3));
  const Quat::Coefficients step =
      (dt / 6) * (k1.coeffs() + 2 * k2.coeffs() + 2 * k3.coeffs() + k4.coeffs());
  return Quat(Quat::Coefficients(orientation.coeffs() + step)).normalized();
}

void pose_rigid_body(const Model& model, const RigidModel& rigid, const RigidState& state,
                     Configuration& configuration) {
  const Mat3 r = state.orientation.normalized().toRotationMatrix();
  const Vec3 velocity = rigid.inverse_mass * state.momentum;
  const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    const Vec3 arm = r * model.local_position[i - model.free_count];
    configuration.position[i] = state.center_of_mass + arm;
    configuration.velocity[i] = velocity + omega.cross(arm);
  }
}

}  // namespace vat
