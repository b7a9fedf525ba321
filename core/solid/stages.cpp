#include "core/solid/stages.h"

#include "core/solid/springs.h"
#include "core/solid/volume.h"

namespace vat {

void add_solid_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.spring_begin[model.implicit_begin] > 0) {
    plan.add("springs", {position, velocity, force}, {force}, &add_spring_forces);
  }
  if (!model.cells.empty()) {
    plan.add("cell_pressure", {position}, {cell_pressure}, &compute_cell_pressure);
    plan.add("cell_forces", {position, cell_pressure, force}, {force}, &add_cell_forces);
  }
}

}  // namespace vat
