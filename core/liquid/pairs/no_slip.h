#pragma once

#include "core/types.h"

namespace vat {

struct Model;
struct StepContext;
class Scratch;

/// Stage that computes LiquidScratch::filled_density, the density that a particle would have if
/// liquid at rest density filled the space beyond no-slip walls. The space behind two walls counts
/// twice.
void fill_liquid_density(StepContext& context);

/// Stage that adds the drag of no-slip walls, which is the viscous force of a half space of liquid
/// beyond each wall.
void add_no_slip_forces(StepContext& context);

/// Returns the drag on liquid particle i at the distance `d` [m] from a no-slip wall, divided by
/// the slip speed along the wall [N s/m]. Requires LiquidScratch::filled_density.
Real no_slip_drag(const Model& model, const Scratch& work, Index i, Real d);

}  // namespace vat
