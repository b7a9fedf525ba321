#pragma once

#include <cstdint>

#include "protocol/frame/grid_frame.h"

namespace vat {

/// Returns the checksum over all blocks of a frame (FRAMES.md, "Check"). A decoder uses the
/// checksum to detect a difference from the encoder, because later frames depend on this frame.
std::uint32_t frame_check(const GridFrame& frame);

}  // namespace vat
