#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace vat::stability {

/// Liquid and solids in a vat of random size that slides or shakes, while the direction of gravity
/// oscillates.
struct RandomVat {
  Scene scene;
  Vec3 tilt_axis = Vec3::UnitX();  ///< axis about which gravity tilts
  Real tilt_angle = 0;             ///< [rad]
  Real tilt_period = 1;            ///< [s]
  Real sound = 0;                  ///< speed of sound of the liquid [m/s]
};

/// Returns a valid scene, identical for the same seed and solver on every machine. Spacings are 5
/// mm to 0.2 m, and vats are 8 to 14 spacings wide. The step is 0.9 of the limit of
/// find_step_limits(), or 0.6 with the `gas` solver, whose limit assumes a liquid at rest. The
/// speed of sound is the recommended one, ten times the maximum speed.
RandomVat random_vat(std::uint64_t seed, PressureSolver solver);

/// Returns the vat with local steps and with solids that are a hundred times as stiff, so that they
/// take sub-steps.
RandomVat with_sub_steps(RandomVat vat);

/// Result of a run.
struct VatReport {
  std::string fault;  ///< empty: none
  std::size_t particles = 0;
  std::uint64_t steps = 0;
  std::uint64_t events = 0;      ///< events of the guard
  std::uint64_t wall_stops = 0;  ///< see AdvanceReport
  std::size_t outside = 0;       ///< maximum number of particles beyond a wall
  Real greatest_speed = 0;       ///< maximum of a liquid particle, relative to the speed of sound
  std::uint64_t hash = 0;
};

/// Runs the scene for ten times the duration of a fall through the vat's height. Checks that no
/// particle leaves, that the guard does not act, and that no speed reaches the speed of sound.
VatReport shake(const RandomVat& vat);

}  // namespace vat::stability
