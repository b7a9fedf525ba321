#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/simulation/simulation.h"

namespace vat::validation {

/// Reads tests/validation/scenes/NAME.json. Throws std::invalid_argument with its errors.
Scene load_scene(const std::string& name);

/// The body of that name. Throws std::out_of_range where there is none.
BodyDescription& body_of(Scene& scene, std::string_view name);

/// The scene with another integrator and step [s]; a tick is one step.
Scene with_method(Scene scene, IntegratorId integrator, Real step);
/// The same with the scene's integrator.
Scene with_step(Scene scene, Real step);

/// A simulation that measures what its steps cost. Throws std::runtime_error where a step fails or
/// the guard had to repeat one: a case must not pass by the guard's help.
class Run {
 public:
  /// `runner` may be null, and must outlive this. Throws std::invalid_argument, with the errors,
  /// where the scene is not valid.
  explicit Run(const Scene& scene, TaskRunner* runner = nullptr);

  /// Goes on to a time [s] that is a whole number of steps away, to one part in 10^6 of a step.
  void advance_to(Real time);
  /// Goes on to `time` and calls `observe` now and after every `interval`, a whole number of steps.
  void observe_until(Real time, Real interval, const std::function<void()>& observe);

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// The body of that name, or the first body. Throws std::out_of_range where there is none.
  BodyView body(std::string_view name) const;
  BodyView body() const;
  Diagnostics diagnostics() const { return simulation_.diagnostics(); }
  /// Kinetic, gravitational, elastic and contact energy [J].
  Real energy() const;

  std::uint64_t steps() const { return steps_; }
  double seconds() const { return seconds_; }  ///< wall time spent in steps
  std::uint64_t force_evaluations() const { return force_evaluations_; }  ///< of all particles
  /// Of single particles, see AdvanceReport.
  std::uint64_t particle_evaluations() const { return particle_evaluations_; }
  std::uint64_t state_hash() const { return simulation_.state_hash(); }

 private:
  Simulation simulation_;
  std::uint64_t steps_ = 0;
  double seconds_ = 0;
  std::uint64_t force_evaluations_ = 0;
  std::uint64_t particle_evaluations_ = 0;
};

}  // namespace vat::validation
