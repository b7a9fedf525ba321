#pragma once

#include "core/model/model.h"
#include "core/support/result.h"

namespace vat {

/// Returns an error for each feature of the model that the device lacks, with the code
/// "not_on_device" and the path of the feature in the scene. The device computes bodies of one
/// liquid and fixed rigid bodies in a vat, with the solver `tait` by fixed steps of velocity
/// Verlet, or with the solver `incompressible` by fixed or adaptive steps of symplectic Euler.
Errors find_features_not_on_device(const Model& model);

}  // namespace vat
