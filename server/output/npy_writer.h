#pragma once

#include "server/output/frame_writer.h"

namespace vat {

/// An array [times, particles, 6] of float64: x, y, z [m], vx, vy, vz [m/s]. The number of
/// particles must not change. Creates the file at once, and fails if that fails.
Result<std::unique_ptr<FrameWriter>> create_npy_writer(const std::string& name);

}  // namespace vat
