#pragma once

#include "core/model/model.h"
#include "core/state/controls.h"
#include "core/state/state.h"

/// Conditions that keep bodies awake at any speed.
namespace vat {

/// Returns whether the scene moves bodies: by a moving vat or wall, settling, or an open emitter
/// before its end. All bodies are then awake.
bool prevents_sleep(const Scene& scene, Real time);

/// Returns whether a body cannot sleep. The reasons are a grab or an applied force, held motion or
/// a future release, future melting, and particles in a nozzle or a drain.
bool is_driven(const Model& model, const State& state, const Controls& controls, Index body);

}  // namespace vat
