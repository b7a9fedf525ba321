#include "core/stepping/runge_kutta.h"

#include "core/solid/spring_changes.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/integrator.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr RungeKuttaStage kExplicitEuler[] = {{0, 1}};
constexpr RungeKuttaStage kHeun[] = {{0, 1.0 / 2}, {1, 1.0 / 2}};
constexpr RungeKuttaStage kRungeKutta4[] = {
    {0, 1.0 / 6}, {1.0 / 2, 1.0 / 3}, {1.0 / 2, 1.0 / 3}, {1, 1.0 / 6}};

/// The rate of change of a rigid body, in the same members: velocity, dq/dt, force, torque.
RigidState rigid_rate(const RigidModel& rigid, const RigidState& at, const Vec3& force,
                      const Vec3& torque) {
  const Vec3 omega = angular_velocity(rigid, at.orientation, at.angular_momentum);
  return {rigid.inverse_mass * at.momentum, orientation_rate(at.orientation, omega), force, torque};
}

void add_scaled(RigidState& sum, Real scale, const RigidState& rate) {
  sum.center_of_mass += scale * rate.center_of_mass;
  sum.orientation.coeffs() += scale * rate.orientation.coeffs();
  sum.momentum += scale * rate.momentum;
  sum.angular_momentum += scale * rate.angular_momentum;
}

void clear(Configuration& sum, const Model& model) {
  sum.position.assign(model.free_count, Vec3::Zero());
  sum.velocity.assign(model.free_count, Vec3::Zero());
  const RigidState zero{Vec3::Zero(), Quat(0, 0, 0, 0), Vec3::Zero(), Vec3::Zero()};
  sum.rigid.assign(model.rigid_bodies.size(), zero);
}

/// Adds the rate k at `at`: increment += weight k, and at = start + dt * reach k.
void accumulate(const ForceModel& f, const Forces& forces, const Configuration& start, Real weight,
                Real dt_reach, Configuration& at, Configuration& increment) {
  const Model& model = f.model;
  for_blocks(f.runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 velocity = at.velocity[i];
      if (i < forces.transport.size()) velocity += forces.transport[i];
      const Vec3 acceleration = model.inverse_mass[i] * forces.particle[i];
      increment.position[i] += weight * velocity;
      increment.velocity[i] += weight * acceleration;
      at.position[i] = start.position[i] + dt_reach * velocity;
      at.velocity[i] = start.velocity[i] + dt_reach * acceleration;
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidState rate = rigid_rate(model.rigid_bodies[b], at.rigid[b], forces.rigid_force[b],
                                       forces.rigid_torque[b]);
    add_scaled(increment.rigid[b], weight, rate);
    at.rigid[b] = start.rigid[b];
    add_scaled(at.rigid[b], dt_reach, rate);
  }
}

/// at = start + dt * increment.
void finish(const ForceModel& f, const Configuration& start, const Configuration& increment,
            Real dt, Configuration& at) {
  for_blocks(f.runner, f.model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      at.position[i] = start.position[i] + dt * increment.position[i];
      at.velocity[i] = start.velocity[i] + dt * increment.velocity[i];
    }
  });
  for (std::size_t b = 0; b < at.rigid.size(); ++b) {
    at.rigid[b] = start.rigid[b];
    add_scaled(at.rigid[b], dt, increment.rigid[b]);
    if (!increment.rigid[b].orientation.coeffs().isZero(0)) at.rigid[b].orientation.normalize();
  }
}

void take_step_of(std::span<const RungeKuttaStage> stages, const StepArguments& step) {
  const auto& [f, state, time, dt, scratch] = step;
  f.enter("combine");
  VAT_CHECK(dt > 0 && !stages.empty());
  scratch.start = state.now;
  clear(scratch.increment, f.model);
  for (std::size_t s = 0; s < stages.size(); ++s) {
    f.evaluate(state.now, time + stages[s].reach * dt, state.forces);
    f.enter("combine");
    const Real next_reach = s + 1 < stages.size() ? stages[s + 1].reach : 0;
    accumulate(f, state.forces, scratch.start, stages[s].weight, next_reach * dt, state.now,
               scratch.increment);
  }
  finish(f, scratch.start, scratch.increment, dt, state.now);
  if (state.now.springs.empty()) return;
  f.enter("change_springs");
  change_springs(f.model, f.runner, state.now, dt);
}

}  // namespace

std::span<const RungeKuttaStage> runge_kutta_stages(IntegratorId id) {
  switch (id) {
    case IntegratorId::explicit_euler:
      return kExplicitEuler;
    case IntegratorId::heun:
      return kHeun;
    case IntegratorId::runge_kutta_4:
      return kRungeKutta4;
    default:
      return {};
  }
}

void take_explicit_euler_step(const StepArguments& step) {
  take_step_of(kExplicitEuler, step);
}
void take_heun_step(const StepArguments& step) {
  take_step_of(kHeun, step);
}
void take_runge_kutta_4_step(const StepArguments& step) {
  take_step_of(kRungeKutta4, step);
}

}  // namespace vat
