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

// Kick, drift, kick: the closing kick's forces open the next step, so a step costs one evaluation.
void take_velocity_verlet_step(const ForceModel& f, State& state, Real time, Real dt) {
  if (!state.forces_current) f.evaluate(state.now, time, state.forces);
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  drift(f.model, f.runner, state.now, dt);
  f.evaluate(state.now, time + dt, state.forces);
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
      take_velocity_verlet_step(force_model, state, time, dt);
      return;
    case IntegratorId::explicit_euler:
    case IntegratorId::heun:
    case IntegratorId::runge_kutta_4:
      take_runge_kutta_step(id, force_model, state, time, dt, scratch);
      return;
  }
}

}  // namespace vat
