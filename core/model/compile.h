#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"

namespace vat {

/// Returns the first nominal step that begins at or after `time` [s]. `step` is the step length
/// [s].
std::uint64_t first_step_from(Real time, Real step);

/// Compiles a valid scene into a model without a plan. `ids` and `samples` have one entry per body
/// of the scene; null samples are computed. `whole` is an optional model with the same materials
/// that contains the bodies of the scene. If it is given, the liquids get the constants of `whole`.
std::shared_ptr<Model> compile_model(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples,
                                     const Model* whole = nullptr);

/// Returns the model with a new position and motion of one body. The result equals compile_model()
/// for the changed scene. Samples of other bodies are reused, so that the cost is a copy of the
/// model and the compilation of one body. If the particles of a body do not follow from its
/// description, they are unchanged.
std::shared_ptr<Model> with_moved_body(const Model& model, std::size_t body, BodyDescription moved);

/// Releases the samples of liquids that can be computed from their descriptions. The state at time
/// 0 must be known before the call. Scenes with inflow or outflow retain all samples, because they
/// are needed again.
void forget_samples(Model& model);
/// Returns the sample of a body. A released sample is computed again.
std::shared_ptr<const SampledBody> sample_of(const Model& model, std::size_t body);

}  // namespace vat
