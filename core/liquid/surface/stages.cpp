#include "core/liquid/surface/stages.h"

#include "core/liquid/surface/cohesion.h"
#include "core/liquid/surface/surface_tension.h"

namespace vat {
namespace {

void add_curvature_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.particle_count > model.liquid_count) {
    plan.add("find_surface", {liquid_cells, solid_cells, pair_clusters}, {surface}, &find_surface);
  } else {
    plan.add("find_surface", {liquid_cells, pair_clusters}, {surface}, &find_surface);
  }
  plan.add("surface_normals", {liquid_cells, pair_clusters, surface},
           {pair_motion, surface_normals}, &find_surface_normals);
  plan.add("surface_tension", {liquid_cells, pair_clusters, surface, surface_normals, force},
           {pair_motion, force}, &add_surface_tension);
}

void add_cohesion_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  plan.add("cohesion", {position, liquid_cells, force}, {force}, &add_cohesion);
  if (model.particle_count > model.liquid_count) {
    plan.add("adhesion", {position, liquid_cells, solid_cells, force}, {force}, &add_adhesion);
  }
}

}  // namespace

void add_surface_stages(const Model& model, PlanBuilder& plan) {
  if (model.has_surface_tension) add_curvature_stages(model, plan);
  if (model.cohesion) add_cohesion_stages(model, plan);
}

}  // namespace vat
