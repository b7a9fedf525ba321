#pragma once

#include "core/model/model.h"
#include "core/state/controls.h"
#include "core/state/state.h"

/// Conditions that keep bodies awake, for all speeds.
namespace vat {

/// Returns whether something moves bodies in contact with it: a vat or a wall that moves, settling,
/// or an open emitter before its end. All bodies then stay awake.
bool prevents_sleep(const Scene& scene, Real time);

/// Returns whether something acts or will act on this body: a grab or an applied force, a motion
/// without forces or a future release, a future melting, or particles in a nozzle or a drain.
bool is_driven(const Model& model, const State& state, const Controls& controls, Index body);

}  // namespace vat
