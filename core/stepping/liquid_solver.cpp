#include "core/stepping/liquid_solver.h"

#include <algorithm>

#include "core/guard/enforce_walls.h"
#include "core/liquid/gas/stages.h"
#include "core/liquid/incompressible/stages.h"
#include "core/liquid/incompressible/volume_solve.h"
#include "core/liquid/tait/stages.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Reflects liquid beyond a wall before the forces at the end of the step are computed. A
/// reflection after this computation would make these forces invalid for the next step.
void return_liquid_inside(const ForceModel& f, State& state, Real time) {
  f.enter("enforce_walls");
  hold_liquid_inside(f, time, state.now);
}

constexpr LiquidSolver kLiquidSolvers[] = {
    {PressureSolver::gas, &add_gas_stages},
    {PressureSolver::tait, &add_tait_stages, nullptr, &return_liquid_inside},
    {PressureSolver::incompressible, &add_incompressible_stages, &project_velocities,
     &correct_density},
};

}  // namespace

const LiquidSolver& liquid_solver_of(PressureSolver id) {
  const auto* found = std::ranges::find(kLiquidSolvers, id, &LiquidSolver::id);
  VAT_CHECK(found != std::end(kLiquidSolvers));
  return *found;
}

const LiquidSolver* acting_liquid_solver(const Model& model) {
  const bool acts = model.liquid_count > 0 && model.scene.forces.pressure;
  return acts ? &liquid_solver_of(model.scene.pressure_solver) : nullptr;
}

}  // namespace vat
