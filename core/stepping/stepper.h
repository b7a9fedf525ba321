#pragma once

#include <cstdint>
#include <optional>

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/stepping/integrator.h"
#include "core/stepping/local_step.h"
#include "core/stepping/step_control.h"

namespace vat {

/// The arguments of a nominal step. The bounds are those of the model.
struct StepInput {
  const ForceModel& force_model;
  State& state;
  const GuardBounds& guard_bounds;
  const StepBounds& step_bounds;
  AdvanceReport& report;

  const Model& model() const { return force_model.model; }
  const Numerics& numerics() const { return force_model.model.scene.numerics; }
  /// The start of the nominal step [s].
  Real time() const { return static_cast<Real>(state.step_count) * numerics().step; }
};

/// A step, or a part of a step that is repeated in shorter parts. `end` is passed because start +
/// length differs from it by rounding.
struct StepInterval {
  Real start;   ///< [s]
  Real length;  ///< [s]
  Real end;     ///< [s]
};

/// Takes the steps of a simulation, checks each of them, and repeats a failed one in shorter parts.
class Stepper {
 public:
  /// Takes the nominal step in the parts that the scene's step control chooses. Returns false if a
  /// part failed in all lengths; the state is then that at the start of this part.
  bool take_nominal_step(const StepInput& input);

  /// Discards the data of earlier steps. Call it if something other than a step has changed the
  /// state.
  void forget() { local_.forget(); }

 private:
  bool take_varied_step(const StepInput& input);
  /// Takes a step, in two, four or eight parts if the whole one fails. Returns false if all failed.
  bool take_guarded_step(const StepInput& input, Real start, Real dt);
  /// Takes one step and checks it. Returns its fault, if any; the state is then invalid.
  std::optional<Fault> take_step(const StepInput& input, const StepInterval& interval);
  /// Takes the step in equal parts. Returns the first fault, if any.
  std::optional<GuardEvent> take_step_in(std::uint32_t parts, const StepInput& input, Real start,
                                         Real whole);
  void take_local_step(const StepInput& input, const StepInterval& interval);
  /// Puts back particles and bodies that the step took beyond a wall. Returns whether there were
  /// any.
  bool enforce_walls_after(const StepInput& input, Real end);
  std::optional<Fault> find_step_fault(const StepInput& input, Real dt) const;
  void undo_step(State& state);
  /// The step length that accuracy and stability allow at `start` [s].
  Real find_allowed_step(const StepInput& input, Real start);
  /// Estimates the rate of motion before the first step, from the forces at `start` and `dt` later.
  Real probe_start(const StepInput& input, Real start, Real dt);

  IntegratorScratch scratch_;
  Configuration step_start_;
  PresentSteps present_steps_;
  MotionProbe probe_;
  LocalStepper local_;
};

}  // namespace vat
