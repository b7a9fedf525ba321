#pragma once

#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Moves liquid particles that have left a periodic world to the opposite side. Solids stay whole,
/// and may move any distance.
void wrap_liquid(const Model& model, TaskRunner* runner, Configuration& configuration);

}  // namespace vat
