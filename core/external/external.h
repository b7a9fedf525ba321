#pragma once

namespace vat {

struct StepContext;

/// Stage: sets the force of each particle to gravity (Boldt eq. 4) and the central field, and adds
/// the forces of users.
void set_external_forces(StepContext& context);

}  // namespace vat
