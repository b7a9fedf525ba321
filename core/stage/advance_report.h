#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/support/names.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

/// A failed step, or a failed part of a step. A step fails if a value is non-finite, or if a
/// particle or body is outside the domain or too fast (see core/guard/guard.h). A step also fails
/// with too many pairs of liquid particles or too many projected contacts. A failed step is undone
/// and repeated in two, four and finally eight parts.
struct GuardEvent {
  enum class Cause { non_finite, outside_domain, too_fast, too_many_pairs };
  Cause cause;
  Real time;  ///< end of the failed step or part [s]
  BodyId body;
  Index particle;  ///< index of the particle within the body, see BodyView
  Real step;       ///< length of the failed step or part [s]
  bool recovered;  ///< false: also eight parts failed, and the simulation should pause
};
template <>
inline constexpr std::array kNamesOf<GuardEvent::Cause>{"non_finite", "outside_domain", "too_fast",
                                                        "too_many_pairs"};

/// Iterations of the solves that iterate until a tolerance is reached, summed over the solves of
/// all steps.
struct IterationCounts {
  std::uint64_t contacts = 0;    ///< sweeps over contacts and Newton steps, of the slowest island
  std::uint64_t damping = 0;     ///< products with the damping matrix
  std::uint64_t springs = 0;     ///< passes over the implicit springs of a body
  std::uint64_t elongation = 0;  ///< sweeps over the springs with limited elongation
  std::uint64_t velocities = 0;  ///< of the solves for velocities of incompressible liquids
  std::uint64_t places = 0;      ///< of the solves for positions of incompressible liquids
};

/// The result of one call of advance().
struct AdvanceReport {
  /// Maximum number of stored events: the first events and the last event. The number is limited
  /// because an unstable scene may have an event in each step.
  static constexpr std::size_t kMaxEvents = 16;

  std::uint64_t steps = 0;         ///< steps taken, including parts of steps and undone steps
  std::uint64_t undone_steps = 0;  ///< failed steps; each causes an event
  /// Number of times that a particle or a rigid body beyond a wall of the vat was moved back (see
  /// core/guard/enforce_walls.h), including undone steps. A positive number means that the springs
  /// of the wall are too soft for the load.
  std::uint64_t wall_stops = 0;
  /// Number of times that the solve of a body's implicit springs did not converge to the tolerance
  /// (see core/solid/implicit_springs.h). The result of such a solve is less accurate, but stable.
  std::uint64_t unsolved_drifts = 0;
  Real least_step = 0;                  ///< shortest step; with local control, of any particle [s]
  Real greatest_step = 0;               ///< longest step; with local control, of any particle [s]
  std::uint64_t force_evaluations = 0;  ///< evaluations of the forces on all particles
  /// Number of evaluations of the forces on single particles, complete or partial. This number
  /// makes the cost of local control and implicit springs comparable with that of full evaluations.
  std::uint64_t particle_evaluations = 0;
  IterationCounts iterations;
  std::uint64_t device_steps = 0;  ///< nominal steps that a device has taken; see StepEngine
  /// The device has failed, and is no longer used. With the code "not_on_device", the device lacks
  /// a feature of the changed scene, and is not used before it has all features again.
  std::optional<Error> device_error;
  bool bodies_changed = false;             ///< true if a body has melted
  std::vector<std::uint64_t> ended_grabs;  ///< ids of grabs with removed or melted particles
  bool failed = false;                     ///< true: the state is that before the call
  std::vector<GuardEvent> events;          ///< in the order of their detection

  /// Adds `event`. If the report already has kMaxEvents events, `event` replaces the last of them.
  void add(const GuardEvent& event);
  void count_evaluation(std::size_t particles) {
    ++force_evaluations;
    particle_evaluations += particles;
  }
  void count_steps(std::uint64_t count, Real least, Real greatest);
};

}  // namespace vat
