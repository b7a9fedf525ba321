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

/// Whether what was read can be gone on with: bytes that say nothing of what they are damaged by
/// may hold anything. Code of all errors: bad_value.
namespace vat {

/// A body as it was saved.
struct SavedBody {
  BodyId id = 0;
  Oscillation damping;                ///< see ModelDamping
  std::optional<SampledBody> sample;  ///< where its description does not give it
};
template <class Archive>
void describe(Archive& archive, Of<Archive, SavedBody>& v) {
  auto& [id, damping, sample] = v;
  archive(id, damping, sample);
}

/// That the scene can be compiled with such bodies; and their ids.
Status check_saved_scene(const Scene& scene, const std::vector<SavedBody>& bodies, BodyId next_id);
Status check_saved_sleepers(const Model& model, const Configuration& at,
                            const std::vector<Index>& islands);
/// That the columns are those of the model.
Status check_saved_state(const Model& model, const State& state);
Status check_saved_controls(const Model& model, const Controls& controls);
/// That a vat can be moved so.
Status check_saved_hand(const HandMotion& hand);

}  // namespace vat
