#include "core/stepping/step_parts.h"

#include <algorithm>

#include "core/numerics/step_limits.h"
#include "core/solid/spring_changes.h"
#include "core/state/controls.h"
#include "core/state/kick_drift.h"
#include "core/stepping/liquid_solver.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Stores the bound of the oscillations of the forces at the end of a step, if they are damped.
void store_damping_bound(const StepArguments& step) {
  if (!step.force_model.model.damping.any) return;
  step.force_model.enter("bound_damping");
  step.state.bound = find_bound(step.force_model, step.state.now);
}

/// Forces of a step of symplectic Euler. In scenes of incompressible liquids, damping forces are
/// those at the resulting velocities, if the step does not resolve them.
void evaluate_with_own_damping(const StepArguments& step) {
  const auto& [f, state, time, dt, scratch] = step;
  const bool must_solve = solves_damping(f.model.scene) && must_solve_own_damping(f.model, dt);
  f.work.keep_dampers = must_solve;
  f.evaluate(state.now, time, state.forces);
  f.work.keep_dampers = false;
  if (!must_solve) return;
  f.enter("solve_damping");
  solve_damping(f, state.now, state.now, time, dt, true, state.forces, scratch.damping);
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
  VAT_CHECK(kept.velocity.size() == now.velocity.size() && kept.rigid.size() == now.rigid.size());
  copy_velocities(f, f.model.free_count, kept, now);
  for (std::size_t b = 0; b < now.rigid.size(); ++b) {
    now.rigid[b].momentum = kept.rigid[b].momentum;
    now.rigid[b].angular_momentum = kept.rigid[b].angular_momentum;
  }
}

/// Forces at `time`, the end of the step, at the velocities that the forces at its start predict.
void evaluate_at_prediction(const StepArguments& step, Real time) {
  const auto& [f, state, start, dt, scratch] = step;
  f.enter("predict_velocities");
  keep_velocities(f, state.now, scratch.start);
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  f.evaluate(state.now, time, state.forces);
  f.enter("predict_velocities");
  restore_velocities(f, scratch.start, state.now);
}

/// Forces at `time`, the end of the step, at the velocities that they cause. The solve starts from
/// velocities of liquids that the last forces predict, which saves iterations.
void evaluate_with_solve(const StepArguments& step, Real time) {
  const ForceModel& f = step.force_model;
  State& state = step.state;
  const Real dt = step.dt;
  f.enter("predict_velocities");
  const bool viscosity = must_solve_viscosity(f.model, dt);
  keep_velocities(f, state.now, step.scratch.start);
  for_blocks(f.runner, f.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      state.now.velocity[i] += (dt / 2 * f.model.inverse_mass[i]) * state.forces.particle[i];
    }
  });
  f.work.keep_dampers = true;
  f.evaluate(state.now, time, state.forces);
  f.work.keep_dampers = false;
  f.enter("solve_damping");
  solve_damping(f, step.scratch.start, state.now, time, dt / 2, viscosity, state.forces,
                step.scratch.damping);
  restore_velocities(f, step.scratch.start, state.now);
}

/// Drifts particles and bodies. Contacts by projection change the velocities with which they drift.
void drift_to_contact(const StepArguments& step) {
  const auto& [f, state, time, dt, scratch] = step;
  if (!f.model.has_projection) {
    f.enter("drift");
    drift(f.model, f.runner, state.now, dt);
    return;
  }
  f.enter("project_contacts");
  scratch.projection.drift(f, state.now, time, dt);
}

}  // namespace

void evaluate_at_start(const Integrator& integrator, const StepArguments& step) {
  if (!integrator.keeps_forces()) {
    evaluate_with_own_damping(step);
  } else if (!step.state.forces_current) {
    step.force_model.evaluate(step.state.now, step.time, step.state.forces);
    store_damping_bound(step);
  }
}

void evaluate_at_end(const StepArguments& step) {
  const ForceModel& f = step.force_model;
  const bool is_damped = f.model.damping.any;
  const Real end = step.time + step.dt;
  if (is_damped && must_solve_damping(step.state.bound, step.dt)) {
    evaluate_with_solve(step, end);
  } else if (is_damped || !f.controls.grabs.empty()) {
    evaluate_at_prediction(step, end);
  } else {
    f.evaluate(step.state.now, end, step.state.forces);
  }
  store_damping_bound(step);
}

void kick_by(const StepArguments& step, Real dt) {
  VAT_CHECK(step.state.forces.particle.size() == step.force_model.model.particle_count);
  step.force_model.enter("kick");
  kick(step.force_model.model, step.force_model.runner, step.state.forces, step.state.now, dt);
}

void damp_springs(const StepArguments& step, Real dt) {
  if (!has_implicit_springs(step.force_model.model)) return;
  step.force_model.enter("implicit_dashpots");
  damp_implicit_springs(step.force_model, step.state.now, dt, step.scratch.implicit_springs);
}

void limit_springs(const StepArguments& step) {
  const ForceModel& f = step.force_model;
  if (f.model.limited_springs.empty()) return;
  f.enter("limit_elongation");
  const int sweeps =
      limit_elongation(f.model, f.runner, step.state.now, step.dt, step.scratch.elongation);
  if (f.report != nullptr) f.report->iterations.elongation += static_cast<std::uint64_t>(sweeps);
}

void drift_particles(const StepArguments& step) {
  const ForceModel& f = step.force_model;
  State& state = step.state;
  if (has_implicit_springs(f.model)) {
    // Impulses of projected contacts precede the springs, so that they stretch no spring.
    f.enter("implicit_springs");
    store_implicit_positions(f.model, state.now, step.scratch.implicit_springs);
    drift_to_contact(step);
    f.enter("implicit_springs");
    drift_implicit_springs(f, state.now, step.dt, step.scratch.implicit_springs);
  } else {
    drift_to_contact(step);
  }
  move_with_transport(f.model, f.runner, state.forces, state.now, step.dt);
}

void solve_liquid_velocities(const StepArguments& step) {
  const LiquidSolver* solver = acting_liquid_solver(step.force_model.model);
  if (solver == nullptr || solver->solve_velocities == nullptr) return;
  step.force_model.enter("project_velocities");
  solver->solve_velocities(step.force_model, step.state, step.time, step.dt);
}

void correct_liquid_positions(const StepArguments& step) {
  const LiquidSolver* solver = acting_liquid_solver(step.force_model.model);
  if (solver == nullptr || solver->correct_positions == nullptr) return;
  solver->correct_positions(step.force_model, step.state, step.time + step.dt);
}

void apply_spring_changes(const StepArguments& step) {
  if (step.state.now.springs.empty()) return;
  step.force_model.enter("change_springs");
  change_springs(step.force_model.model, step.force_model.runner, step.state.now, step.dt);
}

void solve_contact_velocities(const StepArguments& step) {
  const ForceModel& f = step.force_model;
  if (!f.model.has_projection) return;
  f.enter("project_contacts");
  step.scratch.projection.finish(f, step.state.now, step.time, step.dt);
}

}  // namespace vat
