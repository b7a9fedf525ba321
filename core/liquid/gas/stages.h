#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of liquids with the pressure solver `gas`.
void add_gas_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
