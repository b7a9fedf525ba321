#pragma once

#include "core/evaluation/force_model.h"
#include "core/scene/liquid_model.h"
#include "core/stage/plan.h"

namespace vat {

/// A pressure solver for liquids: its stages of a force evaluation, and its solves within a step.
struct LiquidSolver {
  PressureSolver id;
  /// Adds the stages of the solver to the plan of a model with liquids.
  void (*add_stages)(const Model& model, PlanBuilder& plan);
  /// Changes the velocities between the kick and the drift of a step of length `dt` [s] from `time`
  /// [s]. Null if the solver does not change velocities.
  void (*solve_velocities)(const ForceModel& force_model, State& state, Real time,
                           Real dt) = nullptr;
  /// Changes the positions after the drift, at `time` [s], before the forces at the end of the step
  /// are computed. Null if the solver does not change positions.
  void (*correct_positions)(const ForceModel& force_model, State& state, Real time) = nullptr;
};

const LiquidSolver& liquid_solver_of(PressureSolver id);

/// Returns the solver of a model, or null if the model has no liquids or no pressure forces.
const LiquidSolver* acting_liquid_solver(const Model& model);

}  // namespace vat
