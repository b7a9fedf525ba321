#pragma once

#include "protocol/frame/grid_frame.h"

namespace vat {

/// Writes the state that a decoded frame shows to `state`, and reuses the memory of `state`. The
/// positions are those of the frame's grid. Attributes that the frame omits are empty. The bounding
/// radius of a rigid body is at most twice the true one, and gives the same error of its particles.
void read_frame_state(const GridFrame& frame, PublishedState& state);

}  // namespace vat
