#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of surface tension by curvature, and of cohesion and adhesion.
void add_surface_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
