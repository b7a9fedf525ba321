#include "core/step/force_model.h"

namespace vat {

void ForceModel::evaluate(Configuration& configuration, Real time, Forces& forces) const {
  StepContext context{model, controls, time, step, configuration, forces, work, runner};
  for (const Stage& stage : model.plan.stages) {
    if (observer != nullptr) observer->stage_begins(stage.name);
    stage.run(context);
    if (observer != nullptr) observer->stage_ends(stage.name);
  }
  if (report != nullptr) report->count_evaluation(model.particle_count);
  if (probe != nullptr) probe->see(configuration, forces);
}

}  // namespace vat
