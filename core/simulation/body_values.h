#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/scene/body.h"
#include "core/types.h"

namespace vat {

/// Pose and motion of a rigid body.
struct RigidPose {
  Vec3 center_of_mass;    ///< [m]
  Quat orientation;       ///< rotation from body axes (axes of the shape) to world axes
  Vec3 velocity;          ///< velocity of the centre of mass [m/s]
  Vec3 angular_velocity;  ///< world axes [rad/s]
};

/// Read-only view of one body. The view is valid until the next change of the simulation. The index
/// of a particle is its position in the lists. Emitted particles are appended. After drained
/// particles are removed, later particles move up and remain in order. The number of a particle
/// never changes. The n initial particles have the numbers 0 to n - 1, and each emitted particle
/// has the next number.
struct BodyView {
  BodyId id;
  std::string_view name;
  BodyKind kind;
  std::string_view material;
  std::span<const Vec3> positions;   ///< world axes [m]
  std::span<const Vec3> velocities;  ///< world axes [m/s]
  std::span<const Real> masses;      ///< [kg]
  std::span<const Real> radii;       ///< [m]
  std::optional<RigidPose> pose;     ///< only for rigid bodies
  /// Only for rigid bodies: positions relative to the centre of mass, in body axes [m].
  std::span<const Vec3> local_positions;
  /// Only for rigid bodies: origin of the axes of the shape relative to the centre of mass, in body
  /// axes [m].
  Vec3 shape_origin = Vec3::Zero();
  bool is_asleep = false;            ///< see Scene::sleeping
  std::span<const Index> numbers{};  ///< ascending; empty if numbers are indices
};

/// SPH fields of one liquid body at the current positions, with one value for each particle.
struct LiquidFields {
  std::vector<Real> density;   ///< [kg/m^3]
  std::vector<Real> pressure;  ///< [Pa]
};

/// New position and motion of a body. Absent values are unchanged.
struct BodyPlacement {
  Vec3 center_of_mass = Vec3::Zero();  ///< [m]
  std::optional<Quat> orientation{};   ///< only for rigid bodies; as in RigidPose
  std::optional<Vec3> velocity{};      ///< velocity of the whole body, without rotation [m/s]
};

/// Positions and motion of the particles of a body, as in BodyView.
struct BodyMotion {
  std::vector<Vec3> positions;      ///< liquid and deformable bodies, world axes [m]
  std::vector<Vec3> velocities;     ///< liquid and deformable bodies [m/s]
  std::optional<RigidPose> pose{};  ///< for rigid bodies, replaces both lists
};

/// Momenta of a rigid body.
struct RigidMomentum {
  Vec3 linear;   ///< [kg m/s]
  Vec3 angular;  ///< about the centre of mass, world axes [kg m^2/s]
};

}  // namespace vat
