#pragma once

#include "core/types.h"

namespace vat {

struct StepContext;

/// Stage: which pairs may be in contact.
void find_contacts(StepContext& context);

/// Stage: dynamic connections between bodies (interfaces, Boldt def. 0.6) and within deformable
/// ones. Boldt eq. 3 with l = threshold, a dashpot, and no pull; with the friction of
/// core/laws/friction.h.
void add_contacts(StepContext& context);

}  // namespace vat
