#pragma once

#include "core/types.h"

namespace vat {

struct StepContext;

/// Stage: finds the pairs that may be in contact.
void find_contacts(StepContext& context);

/// Stage: adds the forces of dynamic connections between bodies (interfaces, Boldt def. 0.6) and
/// within deformable bodies: Boldt eq. 3 with l = threshold, a dashpot, no attraction, and the
/// friction of core/laws/friction.h.
void add_contacts(StepContext& context);

}  // namespace vat
