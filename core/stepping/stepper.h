#pragma once

#include <cstdint>
#include <optional>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/stepping/control/step_control.h"
#include "core/stepping/integrator.h"
#include "core/stepping/local_step.h"

namespace vat {

/// The arguments of a nominal step.
struct StepInput {
  const ForceModel& force_model;
  State& state;
  const GuardBounds& guard_bounds;
  const StepBounds& step_bounds;
  AdvanceReport& report;

  const Model& model() const { return force_model.model; }
  const Numerics& numerics() const { return force_model.model.scene.numerics; }
  /// Returns the start of the nominal step [s].
  Real time() const { return static_cast<Real>(state.step_count) * numerics().step; }
};

/// The time interval of a step, or of a part of a repeated step. `end` is stored because start +
/// length may differ from the end by rounding.
struct StepInterval {
  Real start;   ///< [s]
  Real length;  ///< [s]
  Real end;     ///< [s]
};

/// Takes and checks the steps of a simulation. Repeats a failed step in shorter parts.
class Stepper {
 public:
  /// Takes the nominal step in the parts that the scene's step control chooses. Returns false if a
  /// part failed with all lengths. The state is then that at the start of the failed part.
  bool take_nominal_step(const StepInput& input);

  /// Discards the data of earlier steps. Must be called after any change of the state outside a
  /// step.
  void forget() { local_.forget(); }

 private:
  bool take_varied_step(const StepInput& input);
  /// Takes a step. A failed step is repeated in two, four and eight parts. Returns false if all
  /// attempts fail.
  bool take_guarded_step(const StepInput& input, Real start, Real dt);
  /// Takes one step and checks the result. Returns the fault of a failed step, after which the
  /// state is invalid.
  std::optional<Fault> take_step(const StepInput& input, const StepInterval& interval);
  /// Takes the step in equal parts until a part fails. Returns the event of the failed part.
  std::optional<GuardEvent> take_step_in(std::uint32_t parts, const StepInput& input, Real start,
                                         Real whole);
  void take_local_step(const StepInput& input, const StepInterval& interval);
  /// Moves particles and bodies beyond a wall back into the vat. Returns whether any of them was
  /// beyond a wall.
  bool enforce_walls_after(const StepInput& input, Real end);
  std::optional<Fault> find_step_fault(const StepInput& input, Real dt) const;
  void undo_step(State& state);
  /// Returns the step length that accuracy and stability allow at the time `start` [s].
  Real find_allowed_step(const StepInput& input, Real start);
  /// Estimates the rate of motion [rad/s] before the first step from the forces at `start` and at
  /// start + dt.
  Real probe_start(const StepInput& input, Real start, Real dt);

  IntegratorScratch scratch_;
  Configuration step_start_;
  PresentSteps present_steps_;
  MotionProbe probe_;
  LocalStepper local_;
};

}  // namespace vat
