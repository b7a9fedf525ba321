#pragma once

#include <vector>

#include "core/types.h"

namespace vat {

struct StepContext;

/// Adds D w to `force`, by particle, where D is the matrix of the viscous forces of coupled liquids
/// (see DampingMatrix): the forces of add_tait_forces(), add_tait_forces_on_solids() and
/// add_viscous_image_forces() with the velocities w, without pressures, and with walls at rest. The
/// configuration is that of the last evaluation.
void add_liquid_drags(const StepContext& context, const std::vector<Vec3>& w,
                      std::vector<Vec3>& force);

}  // namespace vat
