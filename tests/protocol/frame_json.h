#pragma once

#include <string>

#include "tests/protocol/pattern.h"

namespace vat::script {

/// A frame as scripts see it: the header's fields, `bytes`, and `blocks` of {body, kind} with
/// `grid_positions`, or `position` and `orientation`. Throws std::runtime_error for a bad frame.
Json frame_to_json(const std::string& bytes);

}  // namespace vat::script
