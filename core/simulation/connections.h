#pragma once

#include <cstddef>
#include <optional>

#include "core/evaluation/force_model.h"
#include "core/simulation/simulation.h"

namespace vat {

/// Static springs and contacts of a configuration; see Simulation::connections(). Runs the plan
/// into the force model's workspace, which must not be that of the steps, where bodies may push
/// each other. `projected` has what contacts by projection did, of the configuration or of what is
/// stepped of it, whose model is `stepped`.
Connections find_connections(const ForceModel& force_model, Configuration configuration, Real time,
                             const std::vector<ContactImpulse>& projected, const Model& stepped,
                             const ConnectionQuery& query);

}  // namespace vat
