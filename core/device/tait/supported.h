#pragma once

#include "core/model/model.h"
#include "core/support/result.h"

namespace vat {

/// Returns an error for each feature of the model that TaitEngine lacks, with the code
/// "not_on_device" and the path of the feature in the scene. The device computes bodies of one
/// liquid in a vat with slip walls, by the solver `tait` and fixed steps of velocity Verlet.
Errors find_features_not_on_device(const Model& model);

}  // namespace vat
