#pragma once

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace vat {

/// A failed step, or a failed part of one. A step fails if it ends with a non-finite value, outside
/// the domain, too fast (see core/guard/guard.h), or with too many pairs of liquid particles or
/// projected contacts. It is undone and repeated in two, four and finally eight parts.
struct GuardEvent {
  enum class Cause { non_finite, outside_domain, too_fast, too_many_pairs };
  Cause cause;
  Real time;  ///< [s] end of the failed step, or part of one
  BodyId body;
  Index particle;  ///< its number within the body, see BodyView
  Real step;       ///< [s] length of the failed step, or part of one
  bool recovered;  ///< false: eight parts failed too, and the simulation should pause
};
const char* to_string(GuardEvent::Cause cause);

/// The result of a call of advance().
struct AdvanceReport {
  /// An unstable scene may have an event in each step. A report keeps the first ones and the last.
  static constexpr std::size_t kMaxEvents = 16;

  std::uint64_t steps = 0;         ///< steps taken, parts and undone ones included
  std::uint64_t undone_steps = 0;  ///< each had an event
  /// How often a wall of the vat put back a particle or a rigid body that a step had taken beyond
  /// it (see core/guard/enforce_walls.h), undone steps included: its springs are too soft for
  /// the load.
  std::uint64_t wall_stops = 0;
  /// How often the implicit springs of a body were not solved for to their tolerance (see
  /// core/solid/implicit_springs.h): it is then less exact, but stays stable.
  std::uint64_t unsolved_drifts = 0;
  Real least_step = 0;     ///< [s] the shortest and the longest of them; of local control
  Real greatest_step = 0;  ///< the steps of particles
  std::uint64_t force_evaluations = 0;  ///< of all particles at once
  /// How often the forces on one particle were summed, in part or whole: the measure on which local
  /// control and implicit springs compare with the others, whose evaluations count every particle.
  std::uint64_t particle_evaluations = 0;
  bool bodies_changed = false;             ///< some bodies have melted, as the scene describes
  std::vector<std::uint64_t> ended_grabs;  ///< grabs of removed or melted particles
  bool failed = false;                     ///< the state is the one before the call
  std::vector<GuardEvent> events;          ///< in the order in which they were seen

  /// Counts the event. If there are kMaxEvents already, it replaces the last one.
  void add(const GuardEvent& event);
  void count_evaluation(std::size_t particles) {
    ++force_evaluations;
    particle_evaluations += particles;
  }
  void count_steps(std::uint64_t count, Real least, Real greatest);
};

}  // namespace vat
