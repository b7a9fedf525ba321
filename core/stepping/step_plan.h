#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Returns the plan of a model with complete bodies and contact tables.
StepPlan make_step_plan(const Model& model);

/// Returns the result of compile_model(), including the plan of the model.
std::shared_ptr<Model> compile(Scene scene, const std::vector<BodyId>& ids,
                               std::vector<std::shared_ptr<const SampledBody>> samples,
                               const Model* whole = nullptr);

}  // namespace vat
