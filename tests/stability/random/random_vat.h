#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace vat::stability {

/// Liquid, and solids in it, in a vat of any size that slides or shakes, while gravity tilts.
struct RandomVat {
  Scene scene;
  Vec3 tilt_axis = Vec3::UnitX();  ///< about which gravity swings
  Real tilt_angle = 0;             ///< [rad]
  Real tilt_period = 1;            ///< [s]
  Real sound = 0;                  ///< the liquid's speed of sound [m/s]
};

/// Valid, and the same for the same seed and solver on every machine. Spacings are from 5 mm to 0.2
/// m, and vats 8 to 14 of them wide; steps are 0.9 of the limit that find_step_limits() knows, 0.6
/// with the article's gas, whose limit is that of a liquid at rest, and the speed of sound is that
/// which a user is told to choose: ten times the greatest speed.
RandomVat random_vat(std::uint64_t seed, PressureSolver solver);

/// What became of one.
struct VatReport {
  std::string fault;  ///< empty: none
  std::size_t particles = 0;
  std::uint64_t steps = 0;
  std::uint64_t events = 0;      ///< of the guard
  std::uint64_t wall_stops = 0;  ///< as AdvanceReport counts them
  std::size_t outside = 0;       ///< most particles beyond a wall at any look
  Real greatest_speed = 0;       ///< of a liquid particle, in units of the speed of sound
  std::uint64_t hash = 0;
};

/// Runs it for as long as something falls ten times through the vat's height, and checks that no
/// particle leaves, that the guard has nothing to do, and that nothing becomes as fast as sound.
VatReport shake(const RandomVat& vat);

}  // namespace vat::stability
