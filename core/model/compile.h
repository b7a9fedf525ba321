#pragma once

#include <memory>
#include <vector>

#include "core/model/model.h"

namespace vat {

/// Compiles a scene without errors. `ids` and `samples` have one entry per body of the scene; a
/// null sample is made here.
std::shared_ptr<const Model> compile(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples);

}  // namespace vat
