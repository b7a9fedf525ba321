#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// The plan for a model whose bodies and contact tables are complete.
StepPlan make_step_plan(const Model& model);

/// compile_model() with the plan of the model.
std::shared_ptr<Model> compile(Scene scene, const std::vector<BodyId>& ids,
                               std::vector<std::shared_ptr<const SampledBody>> samples,
                               const Model* whole = nullptr);

}  // namespace vat
