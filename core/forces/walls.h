#pragma once

namespace vat {

struct StepContext;

/// Stage: the vat's walls push on particles nearer than their threshold by a unilateral spring and
/// dashpot, as a dynamic connection to the nearest point of the wall would.
void add_wall_forces(StepContext& context);

}  // namespace vat
