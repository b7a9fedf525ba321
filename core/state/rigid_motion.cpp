#include "core/state/rigid_motion.h"

#include <array>
#include <cmath>

#include "core/support/check.h"

namespace vat {
Vec3 angular_velocity(const RigidModel& rigid, const Quat& orientation,
                      const Vec3& angular_momentum) {
  const Mat3 r = orientation.normalized().toRotationMatrix();
  return r * (rigid.inverse_inertia * (r.transpose() * angular_momentum));
}

Vec3 momentum_of(const RigidModel& rigid, const Vec3& velocity) {
  return rigid.axle ? Vec3(Vec3::Zero()) : Vec3(velocity / rigid.inverse_mass);
}

Vec3 angular_momentum_of(const RigidModel& rigid, const Quat& orientation, const Vec3& omega) {
  const Mat3 r = orientation.toRotationMatrix();
  const Vec3 whole = r * (rigid.inertia * (r.transpose() * omega));
  if (!rigid.axle) return whole;
  return rigid.axle->direction.dot(whole) * rigid.axle->direction;
}

void apply_axle(const RigidModel& rigid, Vec3& force, Vec3& torque) {
  if (!rigid.axle) return;
  force.setZero();
  torque = rigid.axle->direction.dot(torque) * rigid.axle->direction;
}

Quat orientation_rate(const Quat& orientation, const Vec3& angular_velocity) {
  const Quat omega(0, angular_velocity.x(), angular_velocity.y(), angular_velocity.z());
  const Quat product = omega * orientation;
  return Quat(Quat::Coefficients(0.5 * product.coeffs()));
}

namespace {

/// The orientation of a body's principal axes, and its angular momentum in these axes.
struct PrincipalState {
  Quat orientation;
  Vec3 angular_momentum;
};

/// The motion of the Hamiltonian rate_excess * L_axis^2 / 2 for `dt`: a rotation about this axis.
void turn_about(int axis, Real rate_excess, Real dt, PrincipalState& state) {
  Vec3& m = state.angular_momentum;
  const Real half = 0.5 * dt * rate_excess * m[axis];
  const Real c = std::cos(half);
  const Real s = std::sin(half);
  Quat turn(c, 0, 0, 0);
  turn.vec()[axis] = s;
  state.orientation = state.orientation * turn;

  const int first = (axis + 1) % 3;
  const int second = (axis + 2) % 3;
  const Real cos = c * c - s * s;
  const Real sin = 2 * s * c;
  const Real kept = m[first];
  m[first] = cos * kept + sin * m[second];
  m[second] = cos * m[second] - sin * kept;
}

/// The parts of a step in the fourth-order composition of a symmetric second-order method (M.
/// Suzuki, Phys. Lett. A 146 (1990) 319).
const Real kOuterShare = 1 / (4 - std::cbrt(Real{4}));
const std::array<Real, 5> kShares = {kOuterShare, kOuterShare, 1 - 4 * kOuterShare, kOuterShare,
                                     kOuterShare};

}  // namespace

// H = |L|^2 / 2 I_r + sum over the other two axes j of (1 / I_j - 1 / I_r) L_j^2 / 2. The first
// term only rotates the body about L, and commutes with the others.
Quat rotate_freely(const RigidModel& rigid, const Quat& orientation, const Vec3& angular_momentum,
                   Real dt) {
  PrincipalState state{orientation * rigid.principal_axes, {}};
  state.angular_momentum = state.orientation.conjugate() * angular_momentum;
  const auto& [reference, near, far] = rigid.splitting;
  const Real common = rigid.inverse_moments[reference];
  const Real near_excess = rigid.inverse_moments[near] - common;
  const Real far_excess = rigid.inverse_moments[far] - common;
  for (const Real share : kShares) {
    turn_about(near, near_excess, share * dt / 2, state);
    turn_about(far, far_excess, share * dt, state);
    turn_about(near, near_excess, share * dt / 2, state);
  }
  const Real rate = common * angular_momentum.norm();
  const Quat about_momentum(Eigen::AngleAxis<Real>(
      rate * dt, rate > 0 ? Vec3(angular_momentum.normalized()) : Vec3(Vec3::UnitX())));
  return (about_momentum * state.orientation * rigid.principal_axes.conjugate()).normalized();
}

void pose_rigid_body(const Model& model, const RigidModel& rigid, const RigidState& state,
                     Configuration& configuration) {
  const Mat3 r = state.orientation.normalized().toRotationMatrix();
  VAT_CHECK(rigid.particles.begin >= model.free_count &&
            rigid.particles.end <= model.particle_count);
  const Vec3 velocity = rigid.inverse_mass * state.momentum;
  const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    const Vec3 arm = r * model.local_position[i - model.free_count];
    configuration.position[i] = state.center_of_mass + arm;
    configuration.velocity[i] = velocity + omega.cross(arm);
  }
}

Real greatest_inverse_mass(const Model& model, Index particle, std::uint64_t step, Real distance) {
  VAT_CHECK(particle < model.particle_count);
  if (particle < model.free_count) return model.inverse_mass[particle];
  const RigidModel& rigid = model.rigid_bodies[model.bodies[model.body[particle]].rigid];
  if (rigid.is_held(step)) return 0;
  Real arm2 = model.local_position[particle - model.free_count].squaredNorm();
  if (distance > 0) arm2 = std::pow(std::sqrt(arm2) + distance, 2);
  return rigid.inverse_mass + rigid.inverse_moments.maxCoeff() * arm2;
}

}  // namespace vat
