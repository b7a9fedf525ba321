#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"

namespace vat {

/// The first nominal step that begins at a time [s] or after it; `step` is their length [s].
std::uint64_t first_step_from(Real time, Real step);

/// Compiles a scene without errors, without its plan. `ids` and `samples` have one entry per body
/// of the scene; a null sample is computed. If the bodies are a part of a model `whole` with the
/// same materials, their liquids get its constants.
std::shared_ptr<Model> compile_model(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples,
                                     const Model* whole = nullptr);

/// What compile_model() makes of the model's scene with one of its bodies beginning elsewhere, and
/// moving otherwise, than its description has it; from the samples of the others, and at no more
/// cost than that of the body itself and a copy. Bodies whose particles are not those of their
/// description keep them.
std::shared_ptr<Model> with_moved_body(const Model& model, std::size_t body, BodyDescription moved);

/// Lets go the samples of liquids that their descriptions can give again; for when the state at
/// time 0 is known. Of scenes in which liquid flows in or out, where they are needed again soon, it
/// keeps all.
void forget_samples(Model& model);
/// That of a body, made again where it was let go.
std::shared_ptr<const SampledBody> sample_of(const Model& model, std::size_t body);

}  // namespace vat
