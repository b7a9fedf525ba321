#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/material.h"
#include "core/support/names.h"

namespace vat {

/// Interaction of two particles at an interface.
enum class InterfaceLaw : std::uint8_t {
  /// Repulsive spring and dashpot along the line between the particles, with Coulomb friction
  /// perpendicular to the line; see core/laws/friction.h.
  penalty,
  lennard_jones,  ///< attractive layer; see core/laws/lennard_jones.h
  sph,            ///< solids contribute to the density and pressure of the liquid
  projection,     ///< no overlap after a step; see core/contact/projection/projection.h
};

template <>
inline constexpr std::array kNamesOf<InterfaceLaw>{"penalty", "lennard_jones", "sph", "projection"};

/// Constants of the contact between bodies. A law uses only its own constants; the others have
/// their default values.
struct InterfaceConstants {
  Real stiffness = 0;  ///< penalty: stiffness; layer: stiffness at the threshold [N/m]
  Real damping = 0;    ///< penalty [N s/m]
  Real friction = 0;   ///< penalty and projection: coefficient mu; 0: frictionless
  InterfaceLaw law = InterfaceLaw::penalty;
  /// Ratio of separation speed and approach speed. For penalty, the ratio replaces damping (see
  /// core/contact/restitution.h). For projection, the default is 0.
  std::optional<Real> restitution{};
  /// Reach of the attraction of a layer, in units of the threshold.
  Real reach = kDefaultReach;

  static constexpr Real kDefaultReach = 2;

  SpringConstants spring() const { return {stiffness, damping}; }
};

/// Name of the walls of the vat in an interface.
inline constexpr const char* kVatMaterial = "vat";

/// Contact angle [degrees] of walls that neither attract nor repel a liquid.
inline constexpr Real kNeutralAngle = 90;

/// Interface (Boldt def. 0.6) between all bodies of two materials, or between a material and the
/// walls of the vat. Connections have the rest length `threshold` and exist at smaller distances.
/// For lennard_jones, connections exist up to the reach.
struct InterfaceDescription {
  std::array<std::string, 2> materials;
  InterfaceConstants constants;
  std::optional<Real> threshold;  ///< default: sum of both radii [m]
  /// Contact angle of a liquid with surface tension, measured inside the liquid [degrees].
  Real contact_angle = kNeutralAngle;
};

}  // namespace vat
