#pragma once

#include "core/diagnostics.h"
#include "core/step/force_model.h"

namespace vat {

/// Diagnostics of a configuration. Runs the plan into the force model's workspace, which must not
/// be that of the steps.
Diagnostics measure(const ForceModel& force_model, Configuration configuration, Real time);

}  // namespace vat
