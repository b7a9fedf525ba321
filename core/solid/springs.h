#pragma once

namespace vat {

struct StepContext;

/// Stage that adds the forces of explicit static connections of deformable bodies: (Boldt eq. 3)
/// with a dashpot along the spring.
void add_spring_forces(StepContext& context);

}  // namespace vat
