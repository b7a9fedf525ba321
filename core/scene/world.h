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

/// Motion of a vat by a user, in addition to its own motion. Along each axis it moves from its
/// present offset and velocity to rest at the target, in the shortest time that kMaxHandSpeed and
/// kMaxHandAcceleration allow. Commands set it, not scene files; see HostInterface::move_vat().
struct HandMotion {
  Real start = 0;                ///< [s]
  Vec3 offset = Vec3::Zero();    ///< at the start [m]
  Vec3 velocity = Vec3::Zero();  ///< at the start [m/s]
  Vec3 target = Vec3::Zero();    ///< [m]
};

/// Names of the axes, and of the walls of the vat in the order of Vat::walls.
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};
inline constexpr std::array<const char*, 6> kWallNames{"x_min", "x_max", "y_min",
                                                       "y_max", "z_min", "z_max"};

/// A wall of the vat.
struct Wall {
  bool no_slip = false;          ///< liquid at the wall has the velocity of the wall
  Vec3 velocity = Vec3::Zero();  ///< of the surface, along the wall [m/s]
};

/// An axis-aligned container with analytic walls, at `min`..`max` at time 0. Without a lid it is
/// open at +z, and its side walls have no upper end. There are no walls across periodic axes.
struct Vat {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  bool lid = false;
  std::optional<SlideMotion> motion;
  std::array<Wall, 6> walls{};  ///< x_min, x_max, y_min, y_max, z_min, z_max
  std::optional<HandMotion> hand{};
};

/// A world that is periodic along some axes. Particles that leave through one side enter through
/// the opposite side, and particles near both sides are neighbours.
struct Periodicity {
  Vec3 min = Vec3::Zero();     ///< read along periodic axes only [m]
  Vec3 max = Vec3::Zero();     ///< read along periodic axes only [m]
  std::array<bool, 3> axes{};  ///< whether x, y, z are periodic
};

/// A field of acceleration -angular_frequency^2 (x - center), which attracts everything to a point.
struct CentralField {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real angular_frequency = 0;  ///< [rad/s]
};

/// A drag on liquids towards the velocity of the vat, at the start of a scene. It damps the sound
/// that a liquid from a lattice emits while it settles.
struct Settling {
  Real drag = 0;   ///< per mass [1/s]; about c/H for a depth H and a speed of sound c
  Real until = 0;  ///< end of the drag [s]
};

/// Thresholds of sleep; see core/sleep/islands.h. A body whose particles are slower than `speed`
/// for the time `after` is stopped, and no longer stepped.
struct Sleeping {
  Real speed = 0.01;  ///< of each particle [m/s]
  Real after = 0.5;   ///< [s]
};

/// A nozzle that adds particles to a liquid body: a tube of moving liquid with an opening. The tube
/// is as long as the support radius of the liquid. Its layers are one spacing apart and move with
/// the speed `speed`, independent of forces. At the opening they become free.
struct Emitter {
  std::string name;
  std::string body;              ///< the liquid body, which has a spacing
  Vec3 position = Vec3::Zero();  ///< centre of the opening [m]
  Vec3 direction{0, 0, -1};      ///< of the flow, of any length except zero
  std::optional<Real> radius{};  ///< of a round opening [m]; in two dimensions half its width
  /// Edges of a rectangular opening [m]. The first is horizontal, and along x for a vertical flow.
  std::optional<std::array<Real, 2>> size{};
  Real speed = 0;                  ///< [m/s]
  Real from = 0;                   ///< time at which the flow reaches the opening [s]
  Real until = kNoEnd;             ///< end of the flow [s]
  std::size_t most_particles = 0;  ///< of the body; a layer that would exceed it is left out
  bool open = true;                ///< no layer enters the tube of a closed emitter

  static constexpr Real kNoEnd = 1e9;
};

/// A box from which liquid is removed at the first step of each tick.
struct Drain {
  std::string name;
  Vec3 min = Vec3::Zero();  ///< [m]
  Vec3 max = Vec3::Zero();  ///< [m]
};

/// Active forces. Inactive forces have no cost.
struct ForceSwitches {
  bool gravity = true;    ///< includes the central field
  bool pressure = true;   ///< of liquids
  bool viscosity = true;  ///< of liquids, including no-slip walls
  bool springs = true;    ///< static connections
  bool contacts = true;   ///< dynamic connections between particles
  bool walls = true;      ///< of the vat
};

}  // namespace vat
