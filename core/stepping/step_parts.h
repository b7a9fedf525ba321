#pragma once

#include "core/stepping/integrator.h"

/// The parts of a step that consists of kicks and a drift; see Stepper::take_step(). A part has no
/// effect if the scene does not need the part.
namespace vat {

/// Evaluates the forces at the start of the step. Integrators with a closing kick reuse the forces
/// of the last step, unless a command or a wall has changed the state.
void evaluate_at_start(const Integrator& integrator, const StepArguments& step);

/// Evaluates the forces at the end of the step. Velocity-dependent forces are evaluated at
/// predicted velocities if this is stable, and otherwise solved for the velocities at the end of
/// the step. Both methods have order 2.
void evaluate_at_end(const StepArguments& step);

/// Changes the velocities by the forces over `dt` [s].
void kick_by(const StepArguments& step, Real dt);

/// Applies the dashpots of implicit springs over `dt` [s].
void damp_springs(const StepArguments& step, Real dt);

/// Limits the elongation of springs in the next drift.
void limit_springs(const StepArguments& step);

/// Moves particles and bodies with their velocities. Solves contacts by projection and implicit
/// springs.
void drift_particles(const StepArguments& step);

/// Makes the velocities of incompressible liquids free of divergence.
void solve_liquid_velocities(const StepArguments& step);

/// Corrects the positions of liquids after the drift; see LiquidSolver::correct_positions.
void correct_liquid_positions(const StepArguments& step);

/// Changes the rest lengths of plastic springs, and tears springs.
void apply_spring_changes(const StepArguments& step);

/// Applies restitution and friction to projected contacts.
void solve_contact_velocities(const StepArguments& step);

}  // namespace vat
