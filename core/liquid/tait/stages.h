#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of liquids with the pressure solver `tait`.
void add_tait_stages(const Model& model, PlanBuilder& plan);

/// Adds the stages before the pressure for coupled liquids, which interact with solids and walls by
/// SPH.
void add_coupled_density_stages(const Model& model, PlanBuilder& plan);

/// Adds the stages after the pressure for coupled liquids.
void add_coupled_force_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
