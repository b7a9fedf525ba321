#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace vat::stability {

/// What became of a scene that should be stable.
struct PropertyReport {
  std::string fault;             ///< the first property that does not hold; empty: all do
  std::uint64_t attempts = 0;    ///< steps and parts of steps taken
  std::uint64_t undone = 0;      ///< of them, by the guard
  std::uint64_t wall_stops = 0;  ///< as AdvanceReport counts them
  std::size_t particles = 0;
  std::size_t outside = 0;           ///< beyond a wall, where that is the fault
  bool has_momentum_budget = false;  ///< the scene's walls and integrator let it close to round-off
  Real momentum_error = 0;           ///< greatest, over the impulses and momenta that there were
  Real momentum_bound = 0;           ///< what of it round-off explains
  Real energy_excess = 0;   ///< greatest, over the energy that there was; below 0: only losses
  Real energy_bound = 0;    ///< what of it the integrator and the liquids explain
  Real contact_energy = 0;  ///< where the snapshot was taken [J]
  std::uint64_t hash = 0;
};

/// Runs the scene for `duration` [s], or `most_steps` where that is less, and checks that
/// - all that it reports is finite and nothing is beyond the walls, and the guard need not end it,
/// - momentum changes by the impulses of gravity and walls alone (velocity Verlet, undamped walls),
/// - energy grows by no more than the walls' work and the integrator's bound,
/// - two and four threads give the same bits as one,
/// - going back to a snapshot, taken where contacts hold the most energy, gives the same bits.
PropertyReport check_properties(const Scene& scene, Real duration, std::uint32_t most_steps);

}  // namespace vat::stability
