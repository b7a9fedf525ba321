#include "core/evaluation/force_model.h"

#include "core/support/check.h"

namespace vat {

void ForceModel::evaluate(Configuration& configuration, Real time, Forces& forces) const {
  VAT_CHECK(configuration.position.size() == model.particle_count &&
            configuration.rigid.size() == model.rigid_bodies.size());
  StepContext context{model, controls, time, step, configuration, forces, work, runner};
  for (const Stage& stage : model.plan.stages) {
    enter(stage.name);
    stage.run(context);
  }
  VAT_CHECK(forces.particle.size() == model.particle_count);
  if (report != nullptr) report->count_evaluation(model.particle_count);
  if (probe != nullptr) probe->see(configuration, forces);
}

}  // namespace vat
