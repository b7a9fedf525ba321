#pragma once

#include "core/types.h"

namespace vat {

struct Model;
struct StepContext;
class Scratch;

/// Stage: what the densities were if the space beyond no-slip walls were full of the liquid at
/// rest. Where two walls meet, that behind both counts twice.
void fill_liquid_density(StepContext& context);

/// Stage: no-slip walls drag the liquid along them: the viscous force of a half space of liquid
/// beyond the wall.
void add_no_slip_forces(StepContext& context);

/// Force of that kind on liquid particle `i`, at the distance `d` [m] from a wall, over the speed
/// at which it slips along the wall [N s/m]. Needs the filled densities.
Real no_slip_drag(const Model& model, const Scratch& work, Index i, Real d);

}  // namespace vat
