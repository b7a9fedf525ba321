#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of liquids with the pressure solver `incompressible`. The stages equal those of
/// weakly compressible liquids, except that the pressure is that of the last step. Without pressure
/// forces, the pressure is that of the solver `tait`.
void add_incompressible_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
