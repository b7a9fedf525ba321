#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace vat::stability {

/// A valid scene that is expected to be stable, the same for the same seed on every machine: one to
/// six bodies of all kinds, shapes and materials, apart from one another, in a vat that may move;
/// walls that bear the fall through the whole vat, and steps below the limits that
/// find_step_limits() knows.
Scene random_scene(std::uint64_t seed);

}  // namespace vat::stability
