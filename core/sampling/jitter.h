#pragma once

#include <vector>

#include "core/types.h"

namespace vat {

/// Shifts each point by a uniformly distributed random distance between -`greatest` and `greatest`
/// [m] along each axis. In two dimensions, y is not shifted. A shift depends only on the seed, the
/// index of the point and the axis, and is equal on all machines.
void jitter(std::vector<Vec3>& points, Real greatest, std::uint32_t seed, int dimensions);

}  // namespace vat
