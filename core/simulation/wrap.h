#pragma once

#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Puts the liquid particles that left a periodic world back into it, through the other side.
/// Solids stay whole, and go as far as they like.
void wrap_liquid(const Model& model, TaskRunner* runner, Configuration& configuration);

}  // namespace vat
