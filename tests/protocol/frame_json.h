#pragma once

#include <string>

#include "protocol/frame_codec.h"
#include "tests/protocol/pattern.h"

namespace vat::script {

/// A frame as scripts see it: the header's fields, `key`, `bytes`, and `blocks` of {body, kind}
/// with `grid_positions`, or `position` and `orientation`. Throws std::runtime_error for a bad
/// frame.
Json frame_to_json(const std::string& bytes, FrameDecoder& decoder);

}  // namespace vat::script
