#pragma once

#include "server/output/frame_writer.h"

namespace vat {

Result<std::unique_ptr<FrameWriter>> create_vtk_writer(const std::string& name,
                                                       std::size_t frame_count);

}  // namespace vat
