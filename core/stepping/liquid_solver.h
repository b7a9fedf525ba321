#pragma once

#include "core/evaluation/force_model.h"
#include "core/scene/scene.h"
#include "core/stage/plan.h"

namespace vat {

/// A liquid solver: its stages of a force evaluation, and its solves within a step.
struct LiquidSolver {
  PressureSolver id;
  /// Adds the stages of a model that has liquids.
  void (*add_stages)(const Model& model, PlanBuilder& plan);
  /// Changes the velocities between the kick and the drift of a step of `dt` from `time`; null: no
  /// such solve.
  void (*solve_velocities)(const ForceModel& force_model, State& state, Real time,
                           Real dt) = nullptr;
  /// Changes the positions after the drift to `time`; null: no such solve.
  void (*solve_density)(const ForceModel& force_model, State& state, Real time) = nullptr;
};

const LiquidSolver& liquid_solver_of(PressureSolver id);

/// The solver of a model with liquids and their pressure; null without.
const LiquidSolver* acting_liquid_solver(const Model& model);

}  // namespace vat
