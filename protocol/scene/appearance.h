#pragma once

#include <optional>
#include <string>

#include "core/scene/material.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Appearance of a material with all members that pictures need.
struct FullAppearance {
  Colour colour;
  Real roughness = 0.5;
  Real metalness = 0;
  Real opacity = 1;
  std::optional<Real> absorption_length;  ///< only if the material states it [m]
  Finish finish = Finish::none;
};

/// Returns the stated members of a material's appearance. Absent members follow from the name of
/// the material if it contains a known word, and otherwise from its constants.
FullAppearance full_appearance(const Material& material);

/// Return an appearance in the format of a scene file.
Json write_appearance(const Appearance& appearance);
Json write_appearance(const FullAppearance& appearance);

namespace scene_parts {
Appearance to_appearance(const Json& value, std::string path, Errors& errors);
}  // namespace scene_parts

}  // namespace vat
