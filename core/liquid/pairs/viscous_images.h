#pragma once

#include <vector>

#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

/// Stage that adds the viscous forces between liquids and their images in walls (see
/// Model::is_coupled). At a no-slip wall, an image has the reversed velocity of its particle, so
/// that the velocity midway is zero (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997)
/// 214, sec. 3.5). At a slip wall, an image has the mirrored velocity, so that the viscous force
/// resists compression against the wall. The force is the liquid's viscous force without the terms
/// that couple two axes. The contributions of the images on opposite sides of a particle to these
/// terms cancel. Without the terms, the force is symmetric in the two particles and never adds
/// energy.
///
/// Slip walls have viscous forces only if a liquid's viscosity exceeds its artificial viscosity,
/// whose purpose is the damping of sound.
void add_viscous_image_forces(StepContext& context);

/// Adds these forces for the given velocities of the particles to `force`. The liquid slots of
/// LiquidScratch::sources must have these velocities. If `walls_move` is false, all walls are at
/// rest.
void add_viscous_image_forces(const StepContext& context, const std::vector<Vec3>& velocities,
                              bool walls_move, std::vector<Vec3>& force);

}  // namespace vat
