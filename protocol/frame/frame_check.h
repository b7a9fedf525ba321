#pragma once

#include <cstdint>

#include "protocol/frame/grid_frame.h"

namespace vat {

/// The check of FRAMES.md over all blocks of a frame: a decoder that has another frame than was
/// encoded would build all later ones on it.
std::uint32_t frame_check(const GridFrame& frame);

}  // namespace vat
