#include "core/stepping/step_plan.h"

#include <utility>

#include "core/contact/stages.h"
#include "core/external/external.h"
#include "core/liquid/surface/stages.h"
#include "core/model/compile.h"
#include "core/rigid/rigid.h"
#include "core/solid/stages.h"
#include "core/stepping/liquid_solver.h"

namespace vat {

StepPlan make_step_plan(const Model& model) {
  using enum Column;
  PlanBuilder plan({position, velocity, rigid_state, kept_pressure});
  if (!model.rigid_bodies.empty()) {
    plan.add("pose_rigid_bodies", {rigid_state}, {position, velocity}, &pose_rigid_bodies);
  }
  plan.add("external_forces", {position, velocity}, {force}, &set_external_forces);
  if (model.liquid_count > 0) {
    liquid_solver_of(model.scene.pressure_solver).add_stages(model, plan);
  }
  add_surface_stages(model, plan);
  add_contact_stages(model, plan);
  add_solid_stages(model, plan);
  add_wall_stages(model, plan);
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
