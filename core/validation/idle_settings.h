#pragma once

#include <vector>

#include "core/validation/validate.h"

namespace vat {

/// Adds a warning, code no_effect, for each setting that has no effect in this scene.
void warn_of_idle_settings(const Scene& scene, std::vector<Warning>& warnings);

}  // namespace vat
