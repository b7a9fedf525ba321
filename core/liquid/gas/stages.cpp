#include "core/liquid/gas/stages.h"

#include "core/liquid/gas/liquid.h"
#include "core/liquid/pairs/no_slip.h"
#include "core/model/acting_forces.h"

namespace vat {
namespace {

void add_viscous_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  const bool pressed = model.scene.forces.pressure;
  if (!model.no_slip_walls.empty()) {
    plan.add("fill_liquid_density", {position, density}, {filled_density}, &fill_liquid_density);
    if (pressed) {
      plan.add("liquid_forces",
               {position, velocity, liquid_cells, liquid_pairs, density, filled_density, pressure,
                force},
               {force}, &add_liquid_forces<LiquidTerms{true, true, true}>);
    } else {
      plan.add("liquid_viscosity",
               {position, velocity, liquid_cells, liquid_pairs, density, filled_density, force},
               {force}, &add_liquid_forces<LiquidTerms{false, true, true}>);
    }
    plan.add("no_slip_walls", {position, velocity, filled_density, force}, {force},
             &add_no_slip_forces);
  } else if (pressed) {
    plan.add("liquid_forces",
             {position, velocity, liquid_cells, liquid_pairs, density, pressure, force}, {force},
             &add_liquid_forces<LiquidTerms{true, true, false}>);
  } else {
    plan.add("liquid_viscosity", {position, velocity, liquid_cells, liquid_pairs, density, force},
             {force}, &add_liquid_forces<LiquidTerms{false, true, false}>);
  }
}

}  // namespace

void add_gas_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  const bool has_pressure = model.scene.forces.pressure;
  plan.add("sort_liquid", {position}, {liquid_cells}, &sort_liquid);
  if (!has_pressure && !has_viscosity(model)) return;  // contacts use the cells
  plan.add("liquid_density", {liquid_cells}, {liquid_pairs, density}, &compute_liquid_density);
  if (has_pressure) plan.add("liquid_pressure", {density}, {pressure}, &compute_liquid_pressure);
  if (has_viscosity(model)) {
    add_viscous_stages(model, plan);
  } else {
    plan.add("liquid_forces_inviscid",
             {position, liquid_cells, liquid_pairs, density, pressure, force}, {force},
             &add_liquid_forces<LiquidTerms{true, false, false}>);
  }
}

}  // namespace vat
