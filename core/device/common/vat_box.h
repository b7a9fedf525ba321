#pragma once

#include <array>

#include "core/laws/vat_motion.h"
#include "core/model/model.h"

namespace vat {

/// Returns the corners of the box of the cells [m]: the vat, or the bodies at time 0 with half
/// their extent around them. Along periodic axes, the box is that of the world. Particles outside
/// are in the outermost cells, which is slower, but not less accurate.
std::array<Vec3, 2> box_of_cells(const Model& model);

/// Returns the first coordinate inside a wall that counts as inside [m]; see wall_distance().
Real plane_of_wall(const Vat& vat, const VatMotion& motion, int wall);

}  // namespace vat
