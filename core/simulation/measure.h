#pragma once

#include "core/diagnostics.h"
#include "core/evaluation/force_model.h"

namespace vat {

/// Measures a configuration. Runs the plan in the workspace of the force model, which must be
/// separate from the workspace of the steps.
Diagnostics measure(const ForceModel& force_model, Configuration configuration, Real time);

/// Runs the plan without external forces. `forces` receives the forces between particles and of
/// walls. The result references the arguments, which must outlive it.
StepContext evaluate_inner_forces(const ForceModel& force_model, Configuration& configuration,
                                  Real time, Forces& forces);

}  // namespace vat
