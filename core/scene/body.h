#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/material.h"
#include "core/support/names.h"

namespace vat {

enum class BodyKind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2 };
template <>
inline constexpr std::array kNamesOf<BodyKind>{"liquid", "deformable", "rigid"};

/// A box along the axes of the body.
struct BoxShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Vec3 size = Vec3::Zero();    ///< whole edges [m]
};
/// A ball.
struct SphereShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real radius = 0;             ///< [m]
};
/// A solid circular cylinder with flat ends.
struct CylinderShape {
  Vec3 center = Vec3::Zero();  ///< of its volume [m]
  Vec3 axis = Vec3::UnitZ();   ///< of any length except zero
  Real radius = 0;             ///< [m]
  Real height = 0;             ///< along the axis, from end to end [m]
};
/// Closed triangle mesh. Triangles are counter-clockwise, seen from outside.
struct MeshShape {
  std::string source;                           ///< origin of the mesh, for messages only
  std::vector<Vec3> vertices;                   ///< [m]
  std::vector<std::array<Index, 3>> triangles;  ///< indices of vertices
};
/// Explicit particles. `velocities`, `masses` and `radii` are empty or as long as `positions`.
/// Empty masses: the mass of the body in equal parts, or density times spacing cubed. Empty radii:
/// the radius of the body. `fixed` lists particles that never move (deformable bodies only).
struct ParticleShape {
  std::vector<Vec3> positions;   ///< [m]
  std::vector<Vec3> velocities;  ///< [m/s]
  std::vector<Real> masses;      ///< [kg]
  std::vector<Real> radii;       ///< [m]
  std::vector<Index> fixed;
};
using Shape = std::variant<BoxShape, SphereShape, CylinderShape, MeshShape, ParticleShape>;

/// One static connection (Boldt def. 0.2) between two particles of its body.
struct SpringDescription {
  Index a = 0;
  Index b = 0;
  SpringConstants constants;
  std::optional<Real> rest_length;  ///< l [m]; default: the distance at the start
};

/// A plane wave amplitude * sin(wave_vector . x + phase).
struct PlaneWave {
  Vec3 amplitude = Vec3::Zero();
  Vec3 wave_vector = Vec3::Zero();  ///< [rad/m]
  Real phase = 0;                   ///< [rad]
};

/// A vector for each point x of the world: gradient (x - center) + the sum of the waves.
struct VectorField {
  Vec3 center = Vec3::Zero();    ///< [m]
  Mat3 gradient = Mat3::Zero();  ///< row i: the derivatives of component i
  std::vector<PlaneWave> waves;
};

/// Melting of a deformable body. It becomes liquid at the first step that begins at the time `at`
/// or later.
struct Melting {
  std::string into;  ///< a material with liquid constants
  Real at = 0;       ///< [s]
};

/// One body. `shape` is in the frame of the body; `position` and `orientation` are those of this
/// frame in the world. `velocity` and `angular_velocity` (world axes, about the centre of mass) are
/// those at the start. Rigid bodies have neither fields nor jitter, and only rigid bodies are held.
struct BodyDescription {
  std::string name;
  BodyKind kind = BodyKind::liquid;
  std::string material;
  Shape shape;
  Real spacing = 0;              ///< lattice spacing of the sampler [m]; unused by ParticleShape
  std::optional<Real> mass{};    ///< whole body [kg]; default: from the material's density
  std::optional<Real> radius{};  ///< particle radius [m]; default: half the spacing
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  std::vector<SpringDescription>
      springs{};  ///< deformable bodies only, in addition to lattice springs
  std::optional<VectorField> velocity_field{};  ///< added to the velocities of the particles [m/s]
  std::optional<VectorField>
      displacement_field{};  ///< added to the positions, not to default rest lengths [m]
  Real jitter = 0;           ///< maximum random shift along each axis, in spacings
  std::uint32_t seed = 0;    ///< of the jitter
  /// Until the time `release` [s], a held rigid body moves as if no force acted on it.
  Real release = 0;
  bool fixed = false;                ///< held for all time
  std::optional<Melting> melting{};  ///< deformable bodies only
};

}  // namespace vat
