#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/scene/device_choice.h"
#include "core/simulation/simulation.h"

namespace vat::validation {

/// Reads tests/validation/scenes/NAME.json. Throws std::invalid_argument with its errors.
Scene load_scene(const std::string& name);

/// Returns the body with this name. Throws std::out_of_range if there is none.
BodyDescription& body_of(Scene& scene, std::string_view name);

/// Returns the scene with another integrator and step [s]. A tick is one step.
Scene with_method(Scene scene, IntegratorId integrator, Real step);
/// Returns the scene with another step [s]. A tick is one step.
Scene with_step(Scene scene, Real step);

/// A device that takes the steps of runs, if it has the features of their scenes.
struct DeviceUse {
  DeviceChoice device;
  std::string refusal{};    ///< path of the first feature that the device lacks, or another reason
  std::uint64_t steps = 0;  ///< nominal steps of the device

  /// Counts `taken` nominal steps.
  void count(std::uint32_t taken, const AdvanceReport& report);
  /// Returns why the device did not take all steps. Returns an empty text if it took them.
  std::string reason() const { return refusal.empty() && steps == 0 ? "no steps" : refusal; }
};

/// A simulation that measures the cost of its steps. Throws std::runtime_error if a step fails or
/// the guard repeats one, because a case must not depend on the guard.
class Run {
 public:
  /// `runner` may be null, and must outlive the run. Without `device`, the CPU takes all steps.
  /// Throws std::invalid_argument with the errors if the scene is invalid, or if the device cannot
  /// be used.
  explicit Run(const Scene& scene, TaskRunner* runner = nullptr,
               std::shared_ptr<DeviceUse> device = nullptr);

  /// Advances to `time` [s], a whole number of steps away, to 10^-6 of a step.
  void advance_to(Real time);
  /// Advances to `time`. Calls `observe` at the start and after every `interval`, a whole number of
  /// steps.
  void observe_until(Real time, Real interval, const std::function<void()>& observe);

  Simulation& simulation() { return simulation_; }
  const Simulation& simulation() const { return simulation_; }
  /// Returns the body with this name, or the first body. Throws std::out_of_range if there is none.
  BodyView body(std::string_view name) const;
  BodyView body() const;
  Diagnostics diagnostics() const { return simulation_.diagnostics(); }
  /// Returns the sum of kinetic, gravitational, elastic and contact energy [J].
  Real energy() const;

  std::uint64_t steps() const { return steps_; }
  double seconds() const { return seconds_; }  ///< wall time spent in steps
  std::uint64_t force_evaluations() const {
    return force_evaluations_;
  }  ///< evaluations for all particles
  /// Returns the evaluations of single particles, see AdvanceReport.
  std::uint64_t particle_evaluations() const { return particle_evaluations_; }
  std::uint64_t state_hash() const { return simulation_.state_hash(); }
  /// Returns the use of the device; null without a device.
  const std::shared_ptr<DeviceUse>& device() const { return device_; }

 private:
  Simulation simulation_;
  std::shared_ptr<DeviceUse> device_;
  std::uint64_t steps_ = 0;
  double seconds_ = 0;
  std::uint64_t force_evaluations_ = 0;
  std::uint64_t particle_evaluations_ = 0;
};

}  // namespace vat::validation
