#include "core/stepping/step_plan.h"

#include <utility>

#include "core/contact/contacts.h"
#include "core/contact/restitution.h"
#include "core/contact/walls.h"
#include "core/external/external.h"
#include "core/liquid/gas/liquid.h"
#include "core/liquid/incompressible/volume_solve.h"
#include "core/liquid/pairs/neighbour_lists.h"
#include "core/liquid/pairs/no_slip.h"
#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/surface/cohesion.h"
#include "core/liquid/surface/surface_tension.h"
#include "core/liquid/tait/transport.h"
#include "core/liquid/tait/weakly_compressible.h"
#include "core/model/acting_forces.h"
#include "core/model/compile.h"
#include "core/rigid/rigid.h"
#include "core/solid/springs.h"
#include "core/solid/volume.h"

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

void add_liquid_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  const bool has_pressure = model.scene.forces.pressure;
  plan.add("sort_liquid", {position}, {liquid_cells}, &sort_liquid);
  if (!has_pressure && !has_viscosity(model)) return;  // the cells are for contacts
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

void add_transport_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.particle_count > model.liquid_count) {
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

/// Liquids that solids and walls take part in.
void add_coupled_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  plan.add("sort_liquid", {position}, {liquid_cells}, &sort_liquid);
  const bool has_solids = model.particle_count > model.liquid_count;
  if (has_solids) {
    plan.add("sort_solids", {position}, {solid_cells}, &sort_solids_in_liquid);
    plan.add("find_pairs", {liquid_cells, solid_cells}, {pair_clusters}, &find_pair_clusters);
  } else {
    plan.add("find_pairs", {liquid_cells}, {pair_clusters}, &find_pair_clusters);
  }
  plan.add("liquid_density", {liquid_cells, pair_clusters}, {density}, &compute_tait_density);
  if (model.is_incompressible) {
    plan.add("recall_pressure", {kept_pressure}, {pressure}, &recall_pressure);
  } else {
    plan.add("liquid_pressure", {density}, {pressure}, &compute_tait_pressure);
  }
  if (has_solids) {
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
  if (model.is_filled || model.has_surface_tension) {
    if (has_solids) {
      plan.add("list_neighbours", {liquid_cells, solid_cells}, {liquid_pairs, liquid_solids},
               static_cast<StageFunction>(&list_neighbours));
    } else {
      plan.add("list_neighbours", {liquid_cells}, {liquid_pairs},
               static_cast<StageFunction>(&list_neighbours));
    }
  }
}

void add_surface_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.particle_count > model.liquid_count) {
    plan.add("find_surface", {liquid_cells, solid_cells, liquid_pairs, liquid_solids}, {surface},
             &find_surface);
  } else {
    plan.add("find_surface", {liquid_cells, liquid_pairs}, {surface}, &find_surface);
  }
  plan.add("surface_normals", {liquid_cells, liquid_pairs, surface}, {surface_normals},
           &find_surface_normals);
  plan.add("surface_tension", {liquid_cells, liquid_pairs, surface, surface_normals, force},
           {force}, &add_surface_tension);
}

void add_cohesion_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  plan.add("cohesion", {position, liquid_cells, force}, {force}, &add_cohesion);
  if (model.particle_count > model.liquid_count) {
    plan.add("adhesion", {position, liquid_cells, solid_cells, force}, {force}, &add_adhesion);
  }
}

void add_contact_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.liquid_count > 0 && !model.is_coupled) {
    plan.add("find_contacts", {position, liquid_cells}, {contact_list}, &find_contacts);
  } else {
    plan.add("find_contacts", {position}, {contact_list}, &find_contacts);
  }
}

/// What contacts and walls do, once it is known which contacts there are.
void add_push_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  const bool has_contacts = has_contact_forces(model);
  if (!model.has_restitution) {
    if (has_contacts) {
      plan.add("contacts", {position, velocity, contact_list, force}, {force}, &add_contacts);
    }
  } else if (has_contacts) {
    plan.add("find_contact_mobilities", {position, rigid_state, contact_list}, {mobility},
             &find_contact_mobilities);
    plan.add("contacts", {position, velocity, rigid_state, contact_list, mobility, force}, {force},
             &add_contacts);
  } else if (!model.walls.empty()) {
    plan.add("find_contact_mobilities", {position, rigid_state}, {mobility},
             &find_contact_mobilities);
  }
}

}  // namespace

StepPlan make_step_plan(const Model& model) {
  using enum Column;
  PlanBuilder plan({position, velocity, rigid_state, kept_pressure});
  if (!model.rigid_bodies.empty()) {
    plan.add("pose_rigid_bodies", {rigid_state}, {position, velocity}, &pose_rigid_bodies);
  }
  plan.add("external_forces", {position, velocity}, {force}, &set_external_forces);
  if (model.is_coupled) {
    add_coupled_stages(model, plan);
    if (has_viscous_images(model)) {
      plan.add("viscous_images", {velocity, liquid_cells, pair_clusters, force},
               {pair_motion, force}, &add_viscous_image_forces);
    }
    if (model.is_filled) add_transport_stages(model, plan);
  } else if (model.liquid_count > 0) {
    add_liquid_stages(model, plan);
  }
  if (model.has_surface_tension) add_surface_stages(model, plan);
  if (model.cohesion) add_cohesion_stages(model, plan);
  if (model.contact_reach > 0) add_contact_stages(model, plan);
  add_push_stages(model, plan);
  if (model.spring_begin[model.implicit_begin] > 0) {
    plan.add("springs", {position, velocity, force}, {force}, &add_spring_forces);
  }
  if (!model.cells.empty()) {
    plan.add("cell_pressure", {position}, {cell_pressure}, &compute_cell_pressure);
    plan.add("cell_forces", {position, cell_pressure, force}, {force}, &add_cell_forces);
  }
  if (has_wall_forces(model) && model.has_restitution) {
    plan.add("walls", {position, velocity, rigid_state, mobility, force}, {force},
             &add_wall_forces);
  } else if (has_wall_forces(model)) {
    plan.add("walls", {position, velocity, force}, {force}, &add_wall_forces);
  }
  if (!model.rigid_bodies.empty()) {
    plan.add("gather_rigid_forces", {position, rigid_state, force}, {rigid_force},
             &gather_rigid_forces);
  }
  return std::move(plan).finish();
}

std::shared_ptr<Model> compile(Scene scene, const std::vector<BodyId>& ids,
                               std::vector<std::shared_ptr<const SampledBody>> samples,
                               const Model* whole) {
  std::shared_ptr<Model> model = compile_model(std::move(scene), ids, std::move(samples), whole);
  model->plan = make_step_plan(*model);
  return model;
}

}  // namespace vat
