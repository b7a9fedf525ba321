#pragma once

#include <optional>

#include "core/scene/world.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Facts about a session's frames that the owner sends to a relay before the first frame of an
/// epoch.
struct FrameFacts {
  std::optional<Vat> vat;    ///< only the members that FrameDomain uses
  double default_error = 0;  ///< [m], see FrameDelivery::set_default_error()
};
Json write_frame_facts(const FrameFacts& facts);
/// Throws Json::exception if a member is missing or has another type.
FrameFacts read_frame_facts(const Json& json);

}  // namespace vat
