#pragma once

#include <memory>
#include <utility>

#include "core/device/common/device_counters.h"
#include "core/device/common/device_method.h"
#include "core/device/common/step_moment.h"
#include "core/model/model.h"

namespace vat {

/// The nominal steps of a call.
struct NominalSteps {
  std::uint64_t first;  ///< number of earlier steps
  std::uint32_t count;
  Real step;        ///< [s]
  bool has_forces;  ///< the device has the forces at the start

  /// Returns the end of the first `steps` of them [s].
  Real time(std::uint32_t steps) const { return static_cast<Real>(first + steps) * step; }
};

/// Returns whether a body is released at the start of `step`. The kept forces do not act on this
/// body; see SimulationImpl::take_guarded_steps().
bool releases_body(const Model& model, std::uint64_t step);

/// Steps of velocity Verlet on a device. The kick at the end of a step is a part of the next step,
/// or of finish().
class VerletMethod : public DeviceMethod {
 public:
  bool take_steps(const EngineInput& input, std::uint32_t steps) final;

 protected:
  explicit VerletMethod(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

  const Model& model() const { return *model_; }

  virtual DeviceCounters& counters() = 0;
  /// Writes a state to the device.
  virtual void write(const State& state) = 0;
  /// Releases the bodies that are free from `step` on.
  virtual void release(std::uint64_t step) = 0;
  /// Saves the present state, or returns to the saved one.
  virtual void save() = 0;
  virtual void restore() = 0;
  /// Moves the particles by `start`, and evaluates the forces at the time `end` [s].
  virtual void evaluate(const StepMoment& start, Real end) = 0;
  /// Returns whether a step of `dt` [s] must solve for the damping by the last forces.
  virtual bool must_solve(Real dt) const = 0;
  /// Solves for the damping in a kick of `dt` [s] at the time `end` [s]. Returns the number of
  /// conjugate-gradient iterations.
  virtual std::uint32_t solve_damping(Real end, Real dt) = 0;
  /// Ends a step at the time of `moment`, with its closing kick. Checks the state.
  virtual void finish(const StepMoment& moment) = 0;
  /// Ends a nominal step in a periodic world, see DeviceMotion::wrap_liquid().
  virtual void wrap_liquid() = 0;
  /// Adds the work of kernels since save() to a report.
  virtual void count_work(AdvanceReport& report) = 0;
  /// Takes `steps`. Returns false if a state is known to be invalid; the remaining steps are then
  /// not taken. This function takes fixed steps.
  virtual bool take_nominal_steps(const NominalSteps& steps, AdvanceReport& report);

  /// Evaluates the forces of the present state, at its time [s].
  void evaluate_at_start(Real time, AdvanceReport& report);
  /// Takes a step whose kick and drift begin with `moment`.
  void take_step(StepMoment moment, Real end, AdvanceReport& report);

 private:
  const std::shared_ptr<const Model> model_;
};

}  // namespace vat
