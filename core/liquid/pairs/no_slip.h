#pragma once

#include "core/types.h"

namespace vat {

struct Model;
struct StepContext;
class Scratch;

/// Stage: computes the densities for liquid at rest in the space beyond no-slip walls. The space
/// behind two walls counts twice.
void fill_liquid_density(StepContext& context);

/// Stage: adds the drag of no-slip walls: the viscous force of a half space of liquid beyond the
/// wall.
void add_no_slip_forces(StepContext& context);

/// The drag on liquid particle `i` at the distance `d` [m] from a no-slip wall, divided by its slip
/// speed along the wall [N s/m]. Needs the filled densities.
Real no_slip_drag(const Model& model, const Scratch& work, Index i, Real d);

}  // namespace vat
