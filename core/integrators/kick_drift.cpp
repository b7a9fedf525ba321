#include <algorithm>

#include "core/integrators/integrator.h"
#include "core/rigid/rigid_motion.h"

namespace vat {

void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt) {
  for_blocks(runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      configuration.position[i] += dt * configuration.velocity[i];
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    RigidState& state = configuration.rigid[b];
    state.center_of_mass += (dt * rigid.inverse_mass) * state.momentum;
    // A held body at rest stays to the bit.
    if (rigid.free_from > 0 && state.angular_momentum.isZero(0)) continue;
    state.orientation = rotate_freely(rigid, state.orientation, state.angular_momentum, dt);
  }
}

void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt) {
  for_blocks(runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      configuration.velocity[i] += (dt * model.inverse_mass[i]) * forces.particle[i];
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    configuration.rigid[b].momentum += dt * forces.rigid_force[b];
    configuration.rigid[b].angular_momentum += dt * forces.rigid_torque[b];
  }
}

namespace {

void take_symplectic_euler_step(const ForceModel& f, State& state, Real time, Real dt) {
  f.evaluate(state.now, time, state.forces);
  kick(f.model, f.runner, state.forces, state.now, dt);
  drift(f.model, f.runner, state.now, dt);
}

void keep_velocities(const Configuration& now, Configuration& kept) {
  kept.velocity = now.velocity;
  kept.rigid = now.rigid;
}

void restore_velocities(const Model& model, const Configuration& kept, Configuration& now) {
  std::copy_n(kept.velocity.begin(), model.free_count, now.velocity.begin());
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    now.rigid[b].momentum = kept.rigid[b].momentum;
    now.rigid[b].angular_momentum = kept.rigid[b].angular_momentum;
  }
}

/// The forces that close a step, at the velocities that the forces at its start predict.
void evaluate_at_prediction(const ForceModel& f, State& state, Real time, Real dt,
                            IntegratorScratch& scratch) {
  keep_velocities(state.now, scratch.start);
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  f.evaluate(state.now, time, state.forces);
  restore_velocities(f.model, scratch.start, state.now);
}

// Kick, drift, kick: the closing kick's forces open the next step, so a step costs one evaluation.
// Forces that depend on velocities are those at the end of the step, or at what is predicted for it
// where that is stable: order 2 either way.
void take_velocity_verlet_step(const ForceModel& f, State& state, Real time, Real dt,
                               IntegratorScratch& scratch) {
  if (!state.forces_current) f.evaluate(state.now, time, state.forces);
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  drift(f.model, f.runner, state.now, dt);
  if (must_solve_damping(f.model, dt)) {
    f.evaluate(state.now, time + dt, state.forces);
    solve_damping(f, state.now, time + dt, dt, state.forces, scratch.damping);
  } else if (f.model.damping.any || !f.controls.grabs.empty()) {
    evaluate_at_prediction(f, state, time + dt, dt, scratch);
  } else {
    f.evaluate(state.now, time + dt, state.forces);
  }
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  state.forces_current = true;
}

}  // namespace

void take_step(IntegratorId id, const ForceModel& force_model, State& state, Real time, Real dt,
               IntegratorScratch& scratch) {
  switch (id) {
    case IntegratorId::symplectic_euler:
      take_symplectic_euler_step(force_model, state, time, dt);
      return;
    case IntegratorId::velocity_verlet:
      take_velocity_verlet_step(force_model, state, time, dt, scratch);
      return;
    case IntegratorId::explicit_euler:
    case IntegratorId::heun:
    case IntegratorId::runge_kutta_4:
      take_runge_kutta_step(id, force_model, state, time, dt, scratch);
      return;
  }
}

}  // namespace vat
