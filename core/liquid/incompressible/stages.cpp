#include "core/liquid/incompressible/stages.h"

#include "core/liquid/incompressible/volume_solve.h"
#include "core/liquid/tait/stages.h"

namespace vat {

void add_incompressible_stages(const Model& model, PlanBuilder& plan) {
  if (!model.is_incompressible) return add_tait_stages(model, plan);
  add_coupled_density_stages(model, plan);
  plan.add("recall_pressure", {Column::kept_pressure}, {Column::pressure}, &recall_pressure);
  add_coupled_force_stages(model, plan);
}

}  // namespace vat
