#include "core/liquid/tait/stages.h"

#include "core/liquid/gas/liquid.h"
#include "core/liquid/pairs/neighbour_lists.h"
#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/tait/transport.h"
#include "core/liquid/tait/weakly_compressible.h"
#include "core/model/acting_forces.h"

namespace vat {
namespace {

bool has_solid_particles(const Model& model) {
  return model.particle_count > model.liquid_count;
}

void add_list_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (has_solid_particles(model)) {
    plan.add("list_neighbours", {liquid_cells, solid_cells}, {liquid_pairs, liquid_solids},
             &list_neighbours);
  } else {
    plan.add("list_neighbours", {liquid_cells}, {liquid_pairs}, &list_neighbours);
  }
}

void add_transport_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (has_solid_particles(model)) {
    plan.add("transport_velocity", {liquid_cells, solid_cells, liquid_pairs, liquid_solids},
             {transport}, &compute_transport_velocity);
    plan.add("transport_forces",
             {velocity, liquid_cells, solid_cells, liquid_pairs, liquid_solids, transport, force},
             {force}, &add_transport_forces);
    return;
  }
  plan.add("transport_velocity", {liquid_cells, liquid_pairs}, {transport},
           &compute_transport_velocity);
  plan.add("transport_forces", {velocity, liquid_cells, liquid_pairs, transport, force}, {force},
           &add_transport_forces);
}

}  // namespace

void add_coupled_density_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  plan.add("sort_liquid", {position}, {liquid_cells}, &sort_liquid);
  if (has_solid_particles(model)) {
    plan.add("sort_solids", {position}, {solid_cells}, &sort_solids_in_liquid);
    plan.add("find_pairs", {liquid_cells, solid_cells}, {pair_clusters}, &find_pair_clusters);
  } else {
    plan.add("find_pairs", {liquid_cells}, {pair_clusters}, &find_pair_clusters);
  }
  plan.add("liquid_density", {liquid_cells, pair_clusters}, {density}, &compute_tait_density);
}

void add_coupled_force_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (has_solid_particles(model)) {
    plan.add("solid_pressure", {liquid_cells, solid_cells, pair_clusters, pressure},
             {solid_pressure, pair_motion}, &extrapolate_pressure);
    plan.add("liquid_forces",
             {velocity, liquid_cells, solid_cells, pair_clusters, density, pressure, solid_pressure,
              force},
             {pair_motion, force}, &add_tait_forces);
    plan.add("liquid_forces_on_solids",
             {liquid_cells, solid_cells, pair_clusters, solid_pressure, pair_motion, force},
             {force}, &add_tait_forces_on_solids);
  } else {
    plan.add("liquid_forces", {velocity, liquid_cells, pair_clusters, density, pressure, force},
             {pair_motion, force}, &add_tait_forces);
  }
  if (has_viscous_images(model) && !is_dragged_by_all_images(model)) {
    plan.add("viscous_images", {velocity, liquid_cells, pair_clusters, pair_motion, force},
             {pair_motion, force}, static_cast<StageFunction>(&add_viscous_image_forces));
  }
  if (model.is_filled) {
    add_list_stages(model, plan);
    add_transport_stages(model, plan);
  }
}

void add_tait_stages(const Model& model, PlanBuilder& plan) {
  add_coupled_density_stages(model, plan);
  plan.add("liquid_pressure", {Column::density}, {Column::pressure}, &compute_tait_pressure);
  add_coupled_force_stages(model, plan);
}

}  // namespace vat
