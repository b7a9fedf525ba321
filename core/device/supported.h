#pragma once

#include "core/model/model.h"
#include "core/support/result.h"

namespace vat {

/// Returns an error for each feature of the model that the device lacks, with the code
/// "not_on_device" and the path of the feature in the scene. DEVICE.md lists the features.
Errors find_features_not_on_device(const Model& model);

}  // namespace vat
