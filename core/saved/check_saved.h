#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/saved/archive.h"
#include "core/state/controls.h"
#include "core/state/state.h"
#include "core/support/result.h"

/// Checks of values that were read from bytes, which may be damaged in any way. Code of all errors:
/// bad_value.
namespace vat {

/// A saved body.
struct SavedBody {
  BodyId id = 0;
  Oscillation damping;                ///< see ModelDamping
  std::optional<SampledBody> sample;  ///< if it does not follow from the description
};

/// Checks that the scene can be compiled with these bodies, and their ids.
Status check_saved_scene(const Scene& scene, const std::vector<SavedBody>& bodies, BodyId next_id);
Status check_saved_sleepers(const Model& model, const Configuration& at,
                            const std::vector<Index>& islands);
/// Checks that the columns are those of the model.
Status check_saved_state(const Model& model, const State& state);
Status check_saved_controls(const Model& model, const Controls& controls);
/// Checks that this motion of a vat is possible.
Status check_saved_hand(const HandMotion& hand);

}  // namespace vat
