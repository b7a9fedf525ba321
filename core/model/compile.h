#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"

namespace vat {

/// The first nominal step that begins at the time [s] or later; `step` is the length of steps [s].
std::uint64_t first_step_from(Real time, Real step);

/// Compiles a scene without errors, without its plan. `ids` and `samples` have one entry per body
/// of the scene; a null sample is computed. If the bodies are a part of a model `whole` with the
/// same materials, their liquids get its constants.
std::shared_ptr<Model> compile_model(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples,
                                     const Model* whole = nullptr);

/// The model with a new position and motion of one body; equals compile_model() for the changed
/// scene. It uses the samples of the other bodies, and costs a copy of the model and the
/// compilation of this body. Bodies whose particles do not follow from their description keep them.
std::shared_ptr<Model> with_moved_body(const Model& model, std::size_t body, BodyDescription moved);

/// Releases the samples of liquids that can be computed from their descriptions. Call it when the
/// state at time 0 is known. In scenes with inflow or outflow it keeps all samples, which are
/// needed again.
void forget_samples(Model& model);
/// The sample of a body, which is computed again if it was released.
std::shared_ptr<const SampledBody> sample_of(const Model& model, std::size_t body);

}  // namespace vat
