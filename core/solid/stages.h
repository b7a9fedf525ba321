#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of springs and of cells of deformable bodies.
void add_solid_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
