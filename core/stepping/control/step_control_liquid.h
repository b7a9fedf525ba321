#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/numerics/stable_step.h"
#include "core/types.h"

/// The step lengths that the motion of liquids allows; see find_present_steps().
namespace vat {

/// The share of the guard's travel that a particle may travel in a step: two bodies may approach
/// each other.
inline constexpr Real kTravelShare = 0.5;

/// Returns the time in which a particle with `speed` [m/s] and `acceleration` [m/s^2] travels the
/// distance `way` [m].
Real travel_time(Real way, Real speed, Real acceleration);

/// Returns the oscillation with the sound of a compressed liquid.
Oscillation compressed(const Model& model, const Oscillation& liquid);

/// The motion of a liquid body in the present state.
struct LiquidMotion {
  Real speed = 0;         ///< maximum relative to the mean velocity of all liquids [m/s]
  Real acceleration = 0;  ///< maximum; 0 if unknown [m/s^2]
  Real pressure = 0;      ///< of lasting_rank(); only for incompressible liquids [Pa]
};

/// Returns the longest step that the motion of a liquid body allows [s].
Real step_of_liquid(const Model& model, std::size_t body, const LiquidMotion& motion);

/// Returns the rank, in ascending order, of the pressure that limits the steps of a liquid with
/// `count` > 0 particles. Only 1 % of the particles have a higher pressure. Higher pressures are
/// impacts, which are too short to disturb the lattice.
std::size_t lasting_rank(std::size_t count);

/// Returns the pressure of lasting_rank() [Pa], or 0 without particles. `highest` is a buffer.
Real lasting_pressure(std::span<const Real> pressures, std::vector<Real>& highest);

/// Returns the least of PresentSteps::particle for particles without known accelerations, of which
/// the fastest one has this speed [m/s]. `own_step` is the least of StepBounds [s], and `travel` is
/// that of GuardBounds [m].
Real step_of_particles(Real own_step, Real travel, Real speed);

}  // namespace vat
