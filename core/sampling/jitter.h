#pragma once

#include <vector>

#include "core/types.h"

namespace vat {

/// Shifts each point by up to `greatest` [m] either way along each axis, evenly distributed; in two
/// dimensions not along y. A shift depends on the seed, the point's index and the axis alone, and
/// is the same on every machine.
void jitter(std::vector<Vec3>& points, Real greatest, std::uint32_t seed, int dimensions);

}  // namespace vat
