#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"

namespace vat {

/// The first nominal step that begins at a time [s] or after it; `step` is their length [s].
std::uint64_t first_step_from(Real time, Real step);

/// Compiles a scene without errors. `ids` and `samples` have one entry per body of the scene; a
/// null sample is made here.
std::shared_ptr<const Model> compile(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples);

}  // namespace vat
