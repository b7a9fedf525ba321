#pragma once

#include "server/output/frame_writer.h"

namespace vat {

/// Binary points for viewers, in single precision: position [m], velocity [m/s], radius [m], colour
/// by kind of body, and the body's place in the scene.
///
/// `frame_count` is the number of times that will be written: it decides on the names of the files,
/// see series_name(). Each file is created by its write(), which gives the errors; creating the
/// writer does not fail.
Result<std::unique_ptr<FrameWriter>> create_ply_writer(const std::string& name,
                                                       std::size_t frame_count);

}  // namespace vat
