#pragma once

namespace vat {

struct StepContext;

/// Stage that sets the force on each particle to gravity (Boldt eq. 4) and the central field, and
/// adds the forces of users.
void set_external_forces(StepContext& context);

}  // namespace vat
