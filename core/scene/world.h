#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "core/types.h"

namespace vat {

/// Oscillation along an axis: offset(t) = axis * stroke/2 * (1 - cos(2 pi t / period)).
struct SlideMotion {
  Vec3 axis = Vec3::UnitX();
  Real stroke = 0;  ///< maximum offset [m]
  Real period = 1;  ///< [s]
};

/// Motion of a vat by a user, in addition to its SlideMotion. Along each axis, the vat moves from
/// `offset` and `velocity` to rest at `target`. The motion takes the shortest time that
/// kMaxHandSpeed and kMaxHandAcceleration permit. Commands set this motion, not scene files; see
/// HostInterface::move_vat().
struct HandMotion {
  Real start = 0;                ///< [s]
  Vec3 offset = Vec3::Zero();    ///< initial offset [m]
  Vec3 velocity = Vec3::Zero();  ///< initial velocity [m/s]
  Vec3 target = Vec3::Zero();    ///< [m]
};

/// Names of the axes, and names of the walls of the vat in the order of Vat::walls.
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};
inline constexpr std::array<const char*, 6> kWallNames{"x_min", "x_max", "y_min",
                                                       "y_max", "z_min", "z_max"};

/// Wall of the vat.
struct Wall {
  bool no_slip = false;          ///< liquid at the wall has the velocity of the wall
  Vec3 velocity = Vec3::Zero();  ///< tangential velocity of the wall surface [m/s]
};

/// Axis-aligned container with analytic walls, at `min`..`max` at time 0. Without a lid, the vat is
/// open at +z, and its side walls have no upper end. A vat has no walls across periodic axes.
struct Vat {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  bool lid = false;
  std::optional<SlideMotion> motion;
  std::array<Wall, 6> walls{};  ///< x_min, x_max, y_min, y_max, z_min, z_max
  std::optional<HandMotion> hand{};
};

/// World that is periodic along some axes. Particles that leave through one side enter through the
/// opposite side. Particles near opposite sides are neighbours.
struct Periodicity {
  Vec3 min = Vec3::Zero();     ///< only for periodic axes [m]
  Vec3 max = Vec3::Zero();     ///< only for periodic axes [m]
  std::array<bool, 3> axes{};  ///< whether x, y, z are periodic
};

/// Acceleration field -angular_frequency^2 (x - center), which attracts all particles to a point.
struct CentralField {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real angular_frequency = 0;  ///< [rad/s]
};

/// Drag on liquids towards the velocity of the vat, at the start of a scene. The drag damps the
/// sound that lattice particles emit while the liquid settles.
struct Settling {
  /// Drag coefficient per mass [1/s]. A suitable value is about c/H for the depth H and the speed
  /// of sound c.
  Real drag = 0;
  Real until = 0;  ///< time at which the drag ends [s]
};

/// Thresholds of sleep; see core/sleep/islands.h. A body is stopped, and no longer stepped, if all
/// its particles were slower than `speed` for the duration `after`.
struct Sleeping {
  Real speed = 0.01;  ///< maximum particle speed [m/s]
  Real after = 0.5;   ///< duration [s]
};

/// Nozzle that adds particles to a liquid body. A nozzle is a tube of moving liquid with an
/// opening. The length of the tube is the support radius of the liquid. Layers of particles, one
/// spacing apart, move through the tube at `speed`, independent of forces. At the opening, the
/// particles become free.
struct Emitter {
  std::string name;
  std::string body;              ///< name of a liquid body with a spacing
  Vec3 position = Vec3::Zero();  ///< centre of the opening [m]
  Vec3 direction{0, 0, -1};      ///< flow direction; any length except zero
  std::optional<Real> radius{};  ///< round opening [m]; in two dimensions half the width
  /// Edge lengths of a rectangular opening [m]. The first edge is horizontal. For a vertical flow,
  /// the first edge is along x.
  std::optional<std::array<Real, 2>> size{};
  Real speed = 0;                  ///< [m/s]
  Real from = 0;                   ///< time at which flow begins at the opening [s]
  Real until = kNoEnd;             ///< time at which flow ends [s]
  std::size_t most_particles = 0;  ///< particle limit of the body; further layers are omitted
  bool open = true;                ///< false: no layer enters the tube

  static constexpr Real kNoEnd = 1e9;
};

/// Box from which liquid particles are removed at the first step of each tick.
struct Drain {
  std::string name;
  Vec3 min = Vec3::Zero();  ///< [m]
  Vec3 max = Vec3::Zero();  ///< [m]
};

/// Active forces. Inactive forces have no computing cost.
struct ForceSwitches {
  bool gravity = true;    ///< gravity and the central field
  bool pressure = true;   ///< liquid pressure
  bool viscosity = true;  ///< liquid viscosity, including no-slip walls
  bool springs = true;    ///< static connections
  bool contacts = true;   ///< dynamic connections between particles
  bool walls = true;      ///< walls of the vat
};

}  // namespace vat
