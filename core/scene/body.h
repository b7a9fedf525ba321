#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/support/names.h"

namespace vat {

enum class BodyKind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2 };
template <>
inline constexpr std::array kNamesOf<BodyKind>{"liquid", "deformable", "rigid"};

/// Box aligned with the axes of the body.
struct BoxShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Vec3 size = Vec3::Zero();    ///< edge lengths [m]
};
/// Solid sphere.
struct SphereShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real radius = 0;             ///< [m]
};
/// Solid circular cylinder with flat ends.
struct CylinderShape {
  Vec3 center = Vec3::Zero();  ///< centre of the volume [m]
  Vec3 axis = Vec3::UnitZ();   ///< direction; any length except zero
  Real radius = 0;             ///< [m]
  Real height = 0;             ///< length along the axis, from end to end [m]
};
/// Closed triangle mesh. Triangles are counter-clockwise, seen from outside.
struct MeshShape {
  std::string source;                           ///< origin of the mesh, only for error messages
  std::vector<Vec3> vertices;                   ///< [m]
  std::vector<std::array<Index, 3>> triangles;  ///< indices into vertices
};
/// Explicit particles. `velocities`, `masses` and `radii` are empty or have the same length as
/// `positions`. If `masses` is empty, the mass of the body is divided equally, or each mass is
/// density times spacing cubed. If `radii` is empty, all particles have the radius of the body.
/// `fixed` lists particles that never move (deformable bodies only).
struct ParticleShape {
  std::vector<Vec3> positions;   ///< [m]
  std::vector<Vec3> velocities;  ///< [m/s]
  std::vector<Real> masses;      ///< [kg]
  std::vector<Real> radii;       ///< [m]
  std::vector<Index> fixed;
};
using Shape = std::variant<BoxShape, SphereShape, CylinderShape, MeshShape, ParticleShape>;

/// Static connection (Boldt def. 0.2), a spring between two particles of one body.
struct SpringDescription {
  Index a = 0;
  Index b = 0;
  SpringConstants constants;
  std::optional<Real> rest_length;  ///< l [m]; default: the distance at the start
};

/// Plane wave amplitude * sin(wave_vector . x + phase).
struct PlaneWave {
  Vec3 amplitude = Vec3::Zero();
  Vec3 wave_vector = Vec3::Zero();  ///< [rad/m]
  Real phase = 0;                   ///< [rad]
};

/// Vector field at world positions x: gradient (x - center) + the sum of the waves.
struct VectorField {
  Vec3 center = Vec3::Zero();    ///< [m]
  Mat3 gradient = Mat3::Zero();  ///< row i contains the derivatives of component i
  std::vector<PlaneWave> waves;
};

/// Melting of a deformable body. The body becomes liquid at the first step that begins at or after
/// the time `at`.
struct Melting {
  std::string into;  ///< name of a material with liquid constants
  Real at = 0;       ///< [s]
};

/// Axle through the centre of mass of a rigid body. The centre of mass is at rest, and the body
/// rotates about the axle only. A brake exerts the torque -damping * angular velocity.
struct Axle {
  Vec3 direction = Vec3::UnitY();  ///< world axes; any length except zero
  Real damping = 0;                ///< of the brake [N m s]
};

/// Description of one body. `shape` is defined in the frame of the body. `position` and
/// `orientation` place this frame in the world. `velocity` and `angular_velocity` are the initial
/// velocities. `angular_velocity` is in world axes, about the centre of mass. Rigid bodies have
/// neither fields nor jitter. Only rigid bodies can be held, driven, or have an axle.
struct BodyDescription {
  std::string name;
  BodyKind kind = BodyKind::liquid;
  std::string material;
  Shape shape;
  Real spacing = 0;              ///< lattice spacing of the sampler [m]; unused by ParticleShape
  std::optional<Real> mass{};    ///< whole body [kg]; default: from the density of the material
  std::optional<Real> radius{};  ///< particle radius [m]; default: half the spacing
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  /// Only for deformable bodies; in addition to lattice springs.
  std::vector<SpringDescription> springs{};
  std::optional<VectorField> velocity_field{};  ///< added to the particle velocities [m/s]
  /// Added to the particle positions, but not to default rest lengths [m].
  std::optional<VectorField> displacement_field{};
  Real jitter = 0;         ///< maximum random shift along each axis, in spacings
  std::uint32_t seed = 0;  ///< random seed of the jitter
  /// Release time [s] of a held rigid body. Until then, the body moves as if no force acted on it.
  Real release = 0;
  bool fixed = false;                ///< true: held for all time
  std::optional<Melting> melting{};  ///< only for deformable bodies
  /// A driven body follows this motion from its position at time 0, independent of forces.
  std::optional<SlideMotion> motion{};
  std::optional<Axle> axle{};
  /// Least number of parts of Numerics::step that the body takes with local control; rounded up to
  /// a power of two. Without effect on liquids and other controls.
  std::uint32_t sub_steps = 1;
};

}  // namespace vat
