#pragma once

namespace vat {

struct StepContext;

/// Stage: what the densities were if the space beyond no-slip walls were full of the liquid at
/// rest. Where two walls meet, that behind both counts twice.
void fill_liquid_density(StepContext& context);

/// Stage: no-slip walls drag the liquid along them: the viscous force of a half space of liquid
/// beyond the wall.
void add_no_slip_forces(StepContext& context);

}  // namespace vat
