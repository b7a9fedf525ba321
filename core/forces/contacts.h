#pragma once

namespace vat {

struct StepContext;

/// Stage: cell order of the deformable and rigid particles.
void sort_solids(StepContext& context);

/// Stage: dynamic connections between bodies (interfaces, Boldt def. 0.6) and within deformable
/// ones. Boldt eq. 3 with l = threshold, a dashpot, and no pull.
void add_contacts(StepContext& context);

}  // namespace vat
