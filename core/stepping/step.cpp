#include "core/rigid/guided_bodies.h"
#include "core/stepping/step_parts.h"
#include "core/stepping/stepper.h"

namespace vat {

std::optional<Fault> Stepper::take_step(const StepInput& input, const StepInterval& interval) {
  const Integrator& integrator = integrator_of(input.numerics().integrator);
  const Real dt = interval.length;
  const StepArguments step{input.force_model, input.state, interval.start, dt, scratch_};

  start_driven_bodies(input.model(), interval.start, interval.end, input.state.now);
  if (input.numerics().control == StepControl::local) {
    take_local_step(input, interval);
  } else if (integrator.take_step != nullptr) {
    integrator.take_step(step);
  } else {
    // Evaluate: the forces at the start of the step.
    evaluate_at_start(integrator, step);
    // Kick: velocities by forces.
    damp_springs(step, dt / 2);
    kick_by(step, integrator.opening_kick * dt);
    limit_springs(step);
    solve_liquid_velocities(step);
    // Drift: positions by velocities.
    drift_particles(step);
    correct_liquid_positions(step);
    apply_spring_changes(step);
    set_driven_velocities(input.model(), interval.end, input.state.now);
    // Evaluate and kick: the forces at the end of the step.
    if (integrator.keeps_forces()) {
      evaluate_at_end(step);
      kick_by(step, integrator.closing_kick * dt);
    }
    // Solve: velocities of contacts and springs.
    solve_contact_velocities(step);
    damp_springs(step, dt / 2);
    if (integrator.keeps_forces()) input.state.forces_current = true;
  }

  set_driven_velocities(input.model(), interval.end, input.state.now);
  brake_axles(input.model(), dt, input.state.now);

  // Check: the state as the step left it, and again if a wall has changed it.
  if (input.numerics().control != StepControl::local) input.report.count_steps(1, dt, dt);
  const std::optional<Fault> fault = find_step_fault(input, dt);
  if (fault || !enforce_walls_after(input, interval.end)) return fault;
  return find_step_fault(input, dt);
}

}  // namespace vat
