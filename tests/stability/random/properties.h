#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"

namespace vat::stability {

/// Result of a scene that should be stable.
struct PropertyReport {
  std::string fault;             ///< the first violated property; empty if none
  std::uint64_t attempts = 0;    ///< steps and parts of steps taken
  std::uint64_t undone = 0;      ///< steps and parts that the guard undid
  std::uint64_t wall_stops = 0;  ///< see AdvanceReport
  std::size_t particles = 0;
  std::size_t outside = 0;  ///< particles beyond a wall, if that is the fault
  bool has_momentum_budget =
      false;                ///< walls and integrator allow a momentum balance up to round-off
  Real momentum_error = 0;  ///< maximum, relative to impulses and momenta
  Real momentum_bound = 0;  ///< part that round-off explains
  Real energy_excess = 0;   ///< maximum, relative to the energy; below 0: losses only
  Real energy_bound = 0;    ///< part that integrator and liquids explain
  Real contact_energy = 0;  ///< at the snapshot [J]
  std::uint64_t hash = 0;
};

/// Runs the scene for `duration` [s], but at most `most_steps`, and checks that
/// - all results are finite, no particle is beyond a wall, and the guard does not end the run,
/// - only gravity and walls change the momentum (velocity Verlet, undamped walls),
/// - energy increases by at most the walls' work and the integrator's bound,
/// - two and four threads give the same bits as one,
/// - restoring a snapshot, taken at the maximum contact energy, gives the same bits.
PropertyReport check_properties(const Scene& scene, Real duration, std::uint32_t most_steps);

}  // namespace vat::stability
