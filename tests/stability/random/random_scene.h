#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace vat::stability {

/// Returns a valid scene that should be stable, identical for the same seed on every machine. It
/// has one to six separate bodies of all kinds, shapes and materials, in a vat that may move. The
/// walls resist a fall through the vat, and steps are below the limits of find_step_limits().
Scene random_scene(std::uint64_t seed);

}  // namespace vat::stability
