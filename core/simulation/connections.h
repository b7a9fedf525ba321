#pragma once

#include "core/evaluation/force_model.h"
#include "core/simulation/simulation.h"

namespace vat {

/// Returns static springs and contacts of a configuration; see HostInterface::connections(). If
/// contact forces are possible, the function runs the plan in the workspace of the force model,
/// which must be separate from the workspace of the steps. `projected` are the contacts by
/// projection of the stepped bodies, and `stepped` is the model of these bodies.
Connections find_connections(const ForceModel& force_model, Configuration configuration, Real time,
                             const std::vector<ContactImpulse>& projected, const Model& stepped,
                             const ConnectionQuery& query);

}  // namespace vat
