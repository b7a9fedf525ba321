#pragma once

#include "server/output/frame_writer.h"

namespace vat {

Result<std::unique_ptr<FrameWriter>> create_npy_writer(const std::string& name);

}  // namespace vat
