#pragma once

#include "core/stepping/integrator.h"

/// The parts of a step of kicks and a drift, see Stepper::take_step(). A part does nothing in a
/// scene that does not need it.
namespace vat {

/// Forces at the start of the step. Integrators that keep forces evaluate them only if a command
/// or a wall has changed the state.
void evaluate_at_start(const Integrator& integrator, const StepArguments& step);

/// Forces at the end of the step. Forces that depend on velocities are those at the velocities at
/// the end of the step, or at predicted ones if this is stable. Both have order 2.
void evaluate_at_end(const StepArguments& step);

/// Changes velocities by the forces over `dt` [s].
void kick_by(const StepArguments& step, Real dt);

/// Applies the dashpots of implicit springs over `dt` [s].
void damp_springs(const StepArguments& step, Real dt);

/// Limits the elongation of springs in the next drift.
void limit_springs(const StepArguments& step);

/// Moves particles and bodies with their velocities, with contacts by projection and implicit
/// springs.
void drift_particles(const StepArguments& step);

/// Makes the velocities of liquids free of divergence.
void solve_liquid_velocities(const StepArguments& step);

/// Moves particles of liquids until their density is that at rest.
void solve_liquid_density(const StepArguments& step);

/// Changes rest lengths of plastic springs, and tears springs.
void apply_spring_changes(const StepArguments& step);

/// Applies restitution and friction to projected contacts.
void solve_contact_velocities(const StepArguments& step);

}  // namespace vat
