#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "server/script/pattern.h"

namespace vat::script {

/// Names of bodies by their ids, from the description.
using BodyNames = std::map<std::uint32_t, std::string>;

/// A frame as scripts see it: the header's fields, `key`, `bytes`, and `blocks` of {body, name,
/// kind}, in metres: of particles their number `particles`, `min` and `max` of their places,
/// `grid_positions`, and {min, max} of each attribute; of the others `position`, and of rigid
/// bodies `orientation`. Throws std::runtime_error for a bad frame.
Json frame_to_json(const std::string& bytes, FrameDecoder& decoder, const BodyNames& names);

}  // namespace vat::script
