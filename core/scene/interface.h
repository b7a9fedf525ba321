#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/material.h"
#include "core/support/names.h"

namespace vat {

/// The interaction of two particles at an interface.
enum class InterfaceLaw : std::uint8_t {
  /// A repulsive spring and dashpot along the line between the particles, and Coulomb friction
  /// perpendicular to this line; see core/laws/friction.h.
  penalty,
  lennard_jones,  ///< an attracting layer, see core/laws/lennard_jones.h
  sph,            ///< solids take part in the density and pressure of the liquid
  projection,     ///< no overlap at the end of a step, see core/contact/projection/projection.h
};

template <>
inline constexpr std::array kNamesOf<InterfaceLaw>{"penalty", "lennard_jones", "sph", "projection"};

/// Constants of the contact between bodies. A law reads its own constants; the others keep their
/// defaults.
struct InterfaceConstants {
  Real stiffness = 0;  ///< penalty; layer: at the threshold [N/m]
  Real damping = 0;    ///< penalty [N s/m]
  Real friction = 0;   ///< penalty and projection: coefficient mu; 0: smooth surfaces
  InterfaceLaw law = InterfaceLaw::penalty;
  /// Separation speed / approach speed. Penalty: replaces damping (see core/contact/restitution.h).
  /// Projection: 0 if absent.
  std::optional<Real> restitution{};
  /// Reach of the attraction of a layer, in thresholds.
  Real reach = kDefaultReach;

  static constexpr Real kDefaultReach = 2;

  SpringConstants spring() const { return {stiffness, damping}; }
};

/// The name of the walls of the vat in an interface.
inline constexpr const char* kVatMaterial = "vat";

/// The contact angle [degrees] of walls that neither attract nor repel a liquid.
inline constexpr Real kNeutralAngle = 90;

/// Interface (Boldt def. 0.6) between all bodies of two materials, or between a material and the
/// walls of the vat. Its connections have the rest length `threshold` and exist below this distance
/// (lennard_jones: below the reach).
struct InterfaceDescription {
  std::array<std::string, 2> materials;
  InterfaceConstants constants;
  std::optional<Real> threshold;  ///< default: the sum of both radii [m]
  /// Contact angle of a liquid with surface tension, measured in the liquid [degrees].
  Real contact_angle = kNeutralAngle;
};

}  // namespace vat
