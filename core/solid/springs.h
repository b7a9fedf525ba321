#pragma once

namespace vat {

struct StepContext;

/// Stage: static connections of deformable bodies that are not implicit, Boldt eq. 3 with a dashpot
/// along the spring.
void add_spring_forces(StepContext& context);

}  // namespace vat
