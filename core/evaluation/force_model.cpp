#include "core/evaluation/force_model.h"

namespace vat {

void ForceModel::evaluate(Configuration& configuration, Real time, Forces& forces) const {
  StepContext context{model, controls, time, step, configuration, forces, work, runner};
  for (const Stage& stage : model.plan.stages) {
    enter(stage.name);
    stage.run(context);
  }
  if (report != nullptr) report->count_evaluation(model.particle_count);
  if (probe != nullptr) probe->see(configuration, forces);
}

}  // namespace vat
