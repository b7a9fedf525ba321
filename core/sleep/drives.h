#pragma once

#include "core/model/model.h"
#include "core/state/controls.h"
#include "core/state/state.h"

/// What keeps bodies awake however slow they are.
namespace vat {

/// Whether something moves what it touches by itself: a vat that slides or has a wall that does,
/// settling that is not over, an emitter that is open and has not come to its end. All stay awake.
bool prevents_sleep(const Scene& scene, Real time);

/// Whether something is done to this body, or will be: users hold or push it, it moves as if no
/// force acted or waits for its release, is to melt, has particles in a nozzle or in a drain.
bool is_driven(const Model& model, const State& state, const Controls& controls, Index body);

}  // namespace vat
