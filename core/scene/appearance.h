#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/support/names.h"
#include "core/types.h"

/// Appearance of a material in pictures. The physics does not read it. A scene stores it, like its
/// texts, so that every copy of the scene contains it.
namespace vat {

/// Colour in sRGB.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Colour&) const = default;
};

/// Pattern on the surface of a solid.
enum class Finish : std::uint8_t { none = 0, wood, brick, rubber, steel, clay };
template <>
inline constexpr std::array kNamesOf<Finish>{"none", "wood", "brick", "rubber", "steel", "clay"};

/// The stated members of an appearance. protocol/scene/appearance.h derives absent members.
/// core/scene/material_members.h lists the ranges and units of the numbers.
struct Appearance {
  std::optional<Colour> colour{};           ///< of a liquid: see absorption_length
  std::optional<Real> roughness{};          ///< 0: mirror, 1: matt
  std::optional<Real> metalness{};          ///< 0: dielectric, 1: metal
  std::optional<Real> opacity{};            ///< 0: transparent, 1: opaque
  std::optional<Real> absorption_length{};  ///< depth at which white light has `colour` [m]
  std::optional<Finish> finish{};
  bool operator==(const Appearance&) const = default;
};

}  // namespace vat
