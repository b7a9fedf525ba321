#pragma once

#include "server/output/frame_writer.h"

namespace vat {

/// A table with the columns time [s], body, kind, particle (index in the body), x, y, z [m], vx,
/// vy, vz [m/s], density [kg/m^3] and pressure [Pa]; the last two are empty except for liquids.
/// Creates the file at once, and fails if that fails.
Result<std::unique_ptr<FrameWriter>> create_csv_writer(const std::string& name);

}  // namespace vat
