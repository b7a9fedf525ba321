#pragma once

#include "core/model/model.h"
#include "core/stage/plan.h"

namespace vat {

/// Adds the stages of contacts between particles, including the mobilities for contacts with walls.
void add_contact_stages(const Model& model, PlanBuilder& plan);

/// Adds the stage of contacts with walls.
void add_wall_stages(const Model& model, PlanBuilder& plan);

}  // namespace vat
