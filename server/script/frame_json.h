#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "server/script/pattern.h"

namespace vat::script {

/// Names of bodies by body id, from the session's description.
using BodyNames = std::map<std::uint32_t, std::string>;

/// Returns a frame in the form that scripts use: fields of the header, `key`, `bytes` and `blocks`.
/// - Each block contains `body`, `name` and `kind`.
/// - Blocks of particles contain their number `particles`, `min` and `max` of positions [m], and
///   `grid_positions`. Each attribute has the members `min` and `max`.
/// - Other blocks contain `position` [m], and rigid bodies also `orientation`.
///
/// Throws std::runtime_error for an invalid frame.
Json frame_to_json(const std::string& bytes, FrameDecoder& decoder, const BodyNames& names);

}  // namespace vat::script
