#pragma once

#include "core/evaluation/force_model.h"
#include "core/simulation/simulation.h"

namespace vat {

/// Static springs and contacts of a configuration; see HostInterface::connections(). If contact
/// forces are possible, the function runs the plan in the force model's workspace. This workspace
/// must not be the one used for steps. `projected` are the contacts by projection of the stepped
/// bodies, whose model is `stepped`.
Connections find_connections(const ForceModel& force_model, Configuration configuration, Real time,
                             const std::vector<ContactImpulse>& projected, const Model& stepped,
                             const ConnectionQuery& query);

}  // namespace vat
