#pragma once

#include "core/diagnostics.h"
#include "core/evaluation/force_model.h"

namespace vat {

/// Diagnostics of a configuration. Runs the plan into the force model's workspace, which must not
/// be that of the steps.
Diagnostics measure(const ForceModel& force_model, Configuration configuration, Real time);

/// Runs the plan but for external forces: `forces` are those of particles and walls on each other.
/// What it gives is of the arguments, which must outlive it.
StepContext evaluate_inner_forces(const ForceModel& force_model, Configuration& configuration,
                                  Real time, Forces& forces);

}  // namespace vat
