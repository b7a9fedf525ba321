#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of liquids with the solver `incompressible`: those of weakly compressible
/// liquids, with the pressure of the last step. Without pressure forces, it is that of `tait`.
void add_incompressible_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
