#pragma once

#include "core/types.h"

namespace vat {

struct StepContext;

/// Stage that finds the pairs of particles that may be in contact.
void find_contacts(StepContext& context);

/// Stage that adds the contact forces between bodies (interfaces, Boldt def. 0.6) and within
/// deformable bodies. The normal force is that of Boldt eq. 3 with l = threshold and a dashpot,
/// limited to repulsion. Adhesive layers and friction follow core/laws/lennard_jones.h and
/// core/laws/friction.h.
void add_contacts(StepContext& context);

}  // namespace vat
