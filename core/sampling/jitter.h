#pragma once

#include <vector>

#include "core/types.h"

namespace vat {

/// Shifts each point by up to `greatest` [m] in both directions along each axis, with a uniform
/// distribution; in two dimensions not along y. A shift depends only on the seed, the index of the
/// point and the axis, and is equal on all machines.
void jitter(std::vector<Vec3>& points, Real greatest, std::uint32_t seed, int dimensions);

}  // namespace vat
