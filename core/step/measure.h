#pragma once

#include "core/diagnostics.h"
#include "core/step/force_model.h"

namespace vat {

/// Diagnostics of a configuration. Runs the plan into `work` and `forces`, which must not be those
/// that the steps use.
Diagnostics measure(const ForceModel& force_model, Configuration configuration, Real time);

}  // namespace vat
