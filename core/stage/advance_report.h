#pragma once

#include <cstdint>
#include <vector>

#include "core/support/names.h"
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
  Index particle;  ///< number of the particle within the body, see BodyView
  Real step;       ///< length of the failed step or part [s]
  bool recovered;  ///< false: eight parts failed too, and the simulation should pause
};
template <>
inline constexpr std::array kNamesOf<GuardEvent::Cause>{"non_finite", "outside_domain", "too_fast",
                                                        "too_many_pairs"};

/// The result of a call of advance().
struct AdvanceReport {
  /// An unstable scene may have an event in each step. A report keeps the first ones and the last.
  static constexpr std::size_t kMaxEvents = 16;

  std::uint64_t steps = 0;         ///< steps taken, including parts and undone ones
  std::uint64_t undone_steps = 0;  ///< each has an event
  /// Number of times that a wall of the vat moved back a particle or a rigid body (see
  /// core/guard/enforce_walls.h), including undone steps. The springs of the wall are then too soft
  /// for the load.
  std::uint64_t wall_stops = 0;
  /// Number of times that the implicit springs of a body were not solved to their tolerance (see
  /// core/solid/implicit_springs.h). The result is then less accurate, but stable.
  std::uint64_t unsolved_drifts = 0;
  Real least_step = 0;                  ///< shortest step, of particles with local control [s]
  Real greatest_step = 0;               ///< longest step, of particles with local control [s]
  std::uint64_t force_evaluations = 0;  ///< evaluations of all particles
  /// Number of evaluations of the forces on single particles, whole or in part. It makes the cost
  /// of local control and implicit springs comparable with that of full evaluations.
  std::uint64_t particle_evaluations = 0;
  bool bodies_changed = false;             ///< some bodies have melted
  std::vector<std::uint64_t> ended_grabs;  ///< grabs of removed or melted particles
  bool failed = false;                     ///< the state is that before the call
  std::vector<GuardEvent> events;          ///< in the order of their detection

  /// Adds an event. If there are kMaxEvents already, it replaces the last one.
  void add(const GuardEvent& event);
  void count_evaluation(std::size_t particles) {
    ++force_evaluations;
    particle_evaluations += particles;
  }
  void count_steps(std::uint64_t count, Real least, Real greatest);
};

}  // namespace vat
