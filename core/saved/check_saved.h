#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"
#include "core/state/controls.h"
#include "core/state/state.h"
#include "core/support/result.h"

/// Checks of values that were read from possibly damaged bytes. All errors have the code bad_value.
namespace vat {

/// Saved data of a body.
struct SavedBody {
  BodyId id = 0;
  Oscillation damping;                ///< see ModelDamping
  std::optional<SampledBody> sample;  ///< only if the description does not determine the sample
};

/// Checks the ids, and that the scene can be compiled with these bodies.
Status check_saved_scene(const Scene& scene, const std::vector<SavedBody>& bodies, BodyId next_id);
Status check_saved_sleepers(const Model& model, const Configuration& at,
                            const std::vector<Index>& islands);
/// Checks that the arrays of the state have the sizes that the model requires.
Status check_saved_state(const Model& model, const State& state);
Status check_saved_controls(const Model& model, const Controls& controls);
/// Checks that the motion of a vat by a user is within its limits.
Status check_saved_hand(const HandMotion& hand);

}  // namespace vat
