#include <algorithm>

#include "core/numerics/step_limits.h"
#include "core/solid/elongation_limit.h"
#include "core/solid/spring_changes.h"
#include "core/state/controls.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/integrator.h"

namespace vat {

namespace {

void kick_by(const ForceModel& f, State& state, Real dt) {
  f.enter("kick");
  kick(f.model, f.runner, state.forces, state.now, dt);
}

void limit_springs(const ForceModel& f, State& state, Real dt) {
  if (f.model.limited_springs.empty()) return;
  f.enter("limit_elongation");
  limit_elongation(f.model, f.runner, state.now, dt);
}

void let_springs_change(const ForceModel& f, State& state, Real dt) {
  if (state.now.springs.empty()) return;
  f.enter("change_springs");
  change_springs(f.model, f.runner, state.now, dt);
}

/// Of the forces at the end of a step that are damped.
void keep_bound(const ForceModel& f, State& state) {
  f.enter("bound_damping");
  state.bound = find_bound(f, state.now);
}

/// A drift that contacts by projection take part in, where there are any.
void drift_to_contact(const ForceModel& f, State& state, Real time, Real dt,
                      IntegratorScratch& scratch) {
  if (!f.model.has_projection) {
    f.enter("drift");
    drift(f.model, f.runner, state.now, dt);
    return;
  }
  f.enter("project_contacts");
  scratch.projection.drift(f, state.now, time, dt);
}

/// What contacts by projection do once the velocities at the end of the step are known.
void finish_contacts(const ForceModel& f, State& state, Real time, Real dt,
                     IntegratorScratch& scratch) {
  if (!f.model.has_projection) return;
  f.enter("project_contacts");
  scratch.projection.finish(f, state.now, time, dt);
}

/// The forces of a step of symplectic Euler: in scenes of incompressible liquids, those that damp
/// are at the velocities that they lead to, where the step does not resolve them.
void evaluate_for_kick(const ForceModel& f, State& state, Real time, Real dt,
                       IntegratorScratch& scratch) {
  const bool must_solve = solves_damping(f.model.scene) && must_solve_own_damping(f.model, dt);
  f.work.keep_dampers = must_solve;
  f.evaluate(state.now, time, state.forces);
  f.work.keep_dampers = false;
  if (!must_solve) return;
  f.enter("solve_damping");
  solve_damping(f, state.now, state.now, time, dt, true, state.forces, scratch.damping);
}

void take_symplectic_euler_step(const ForceModel& f, State& state, Real time, Real dt,
                                IntegratorScratch& scratch) {
  evaluate_for_kick(f, state, time, dt, scratch);
  kick_by(f, state, dt);
  limit_springs(f, state, dt);
  if (f.model.is_incompressible) {
    f.enter("project_velocities");
    state.volume.velocities = project_velocities(f, state.now, time, dt, scratch.volume);
  }
  drift_to_contact(f, state, time, dt, scratch);
  move_with_transport(f.model, f.runner, state.forces, state.now, dt);
  if (f.model.is_incompressible) {
    f.enter("correct_density");
    state.volume.places = correct_density(f, state.now, time + dt, scratch.volume);
  }
  let_springs_change(f, state, dt);
  finish_contacts(f, state, time, dt, scratch);
}

void copy_velocities(const ForceModel& f, std::size_t count, const Configuration& from,
                     Configuration& to) {
  for_blocks(f.runner, count, [&](std::size_t begin, std::size_t end) {
    std::copy(from.velocity.data() + begin, from.velocity.data() + end, to.velocity.data() + begin);
  });
}

void keep_velocities(const ForceModel& f, const Configuration& now, Configuration& kept) {
  kept.velocity.resize(now.velocity.size());
  copy_velocities(f, now.velocity.size(), now, kept);
  kept.rigid = now.rigid;
}

void restore_velocities(const ForceModel& f, const Configuration& kept, Configuration& now) {
  copy_velocities(f, f.model.free_count, kept, now);
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    now.rigid[b].momentum = kept.rigid[b].momentum;
    now.rigid[b].angular_momentum = kept.rigid[b].angular_momentum;
  }
}

/// The forces that close a step, at the velocities that the forces at its start predict.
void evaluate_at_prediction(const ForceModel& f, State& state, Real time, Real dt,
                            IntegratorScratch& scratch) {
  f.enter("predict_velocities");
  keep_velocities(f, state.now, scratch.start);
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  f.evaluate(state.now, time, state.forces);
  f.enter("predict_velocities");
  restore_velocities(f, scratch.start, state.now);
}

/// The forces that close a step, at the velocities that they lead to. Liquids whose viscosity needs
/// no solving are predicted.
void evaluate_with_solve(const ForceModel& f, State& state, Real time, Real dt,
                         IntegratorScratch& scratch) {
  f.enter("predict_velocities");
  const bool viscosity = must_solve_viscosity(f.model, dt);
  keep_velocities(f, state.now, scratch.start);
  if (!viscosity) {
    for_blocks(f.runner, f.model.liquid_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        state.now.velocity[i] += (dt / 2 * f.model.inverse_mass[i]) * state.forces.particle[i];
      }
    });
  }
  f.work.keep_dampers = true;
  f.evaluate(state.now, time, state.forces);
  f.work.keep_dampers = false;
  f.enter("solve_damping");
  solve_damping(f, scratch.start, state.now, time, dt / 2, viscosity, state.forces,
                scratch.damping);
  restore_velocities(f, scratch.start, state.now);
}

bool has_implicit_springs(const Model& model) {
  return model.implicit_begin < model.free_count;
}

/// The drift between velocity Verlet's kicks.
void drift_with_springs(const ForceModel& f, State& state, Real time, Real dt,
                        IntegratorScratch& scratch) {
  if (!has_implicit_springs(f.model)) {
    drift_to_contact(f, state, time, dt, scratch);
    return;
  }
  // Impulses of contacts by projection come before the springs, which stretch by none of them.
  f.enter("implicit_springs");
  keep_implicit_places(f.model, state.now, scratch.implicit_springs);
  drift_to_contact(f, state, time, dt, scratch);
  f.enter("implicit_springs");
  drift_implicit_springs(f, state.now, dt, scratch.implicit_springs);
}

/// Implicit springs' dashpots, before the first kick and after the last.
void damp_with_springs(const ForceModel& f, Configuration& now, Real dt,
                       IntegratorScratch& scratch) {
  if (!has_implicit_springs(f.model)) return;
  f.enter("implicit_dashpots");
  damp_implicit_springs(f, now, dt, scratch.implicit_springs);
}

// Kick, drift, kick: the closing kick's forces open the next step, so a step costs one evaluation.
// Forces that depend on velocities are those at the end of the step, or at what is predicted for it
// where that is stable: order 2 either way.
void take_velocity_verlet_step(const ForceModel& f, State& state, Real time, Real dt,
                               IntegratorScratch& scratch) {
  const bool is_damped = f.model.damping.any;
  if (!state.forces_current) {
    f.evaluate(state.now, time, state.forces);
    if (is_damped) keep_bound(f, state);
  }
  damp_with_springs(f, state.now, dt / 2, scratch);
  kick_by(f, state, dt / 2);
  limit_springs(f, state, dt);
  drift_with_springs(f, state, time, dt, scratch);
  move_with_transport(f.model, f.runner, state.forces, state.now, dt);
  let_springs_change(f, state, dt);
  if (is_damped && must_solve_damping(state.bound, dt)) {
    evaluate_with_solve(f, state, time + dt, dt, scratch);
  } else if (is_damped || !f.controls.grabs.empty()) {
    evaluate_at_prediction(f, state, time + dt, dt, scratch);
  } else {
    f.evaluate(state.now, time + dt, state.forces);
  }
  if (is_damped) keep_bound(f, state);
  kick_by(f, state, dt / 2);
  finish_contacts(f, state, time, dt, scratch);
  damp_with_springs(f, state.now, dt / 2, scratch);
  state.forces_current = true;
}

}  // namespace

void take_step(IntegratorId id, const ForceModel& force_model, State& state, Real time, Real dt,
               IntegratorScratch& scratch) {
  switch (id) {
    case IntegratorId::symplectic_euler:
      take_symplectic_euler_step(force_model, state, time, dt, scratch);
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
