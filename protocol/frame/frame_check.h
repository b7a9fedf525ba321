#pragma once

#include <cstdint>

#include "protocol/frame/grid_frame.h"

namespace vat {

/// Returns the checksum of FRAMES.md over all blocks of a frame. It detects a decoder that differs
/// from the encoder, because later frames depend on this frame.
std::uint32_t frame_check(const GridFrame& frame);

}  // namespace vat
