#pragma once

#include "core/contact/projection/projection.h"
#include "core/damping/damping_solve.h"
#include "core/evaluation/force_model.h"
#include "core/scene/numerics.h"
#include "core/solid/elongation_limit.h"
#include "core/solid/implicit_springs.h"
#include "core/state/state.h"

namespace vat {

/// Buffers of integrators that persist between steps.
struct IntegratorScratch {
  Configuration start;
  Configuration increment;  ///< weighted sum of the rates of a Runge-Kutta step
  DampingScratch damping;
  ImplicitSpringsScratch implicit_springs;
  ElongationScratch elongation;
  ContactProjection projection;
};

/// The arguments of a step of an integrator.
struct StepArguments {
  const ForceModel& force_model;
  State& state;
  Real time;  ///< start of the step [s]
  Real dt;    ///< length of the step [s]
  IntegratorScratch& scratch;
};

/// A time integrator. A step is a sequence of kicks (changes of velocities by forces) and a drift
/// (change of positions by velocities), or one call of `take_step`.
///
/// | integrator | force evaluations | order |
/// |---|---|---|
/// | explicit_euler | 1 | 1 |
/// | symplectic_euler | 1 | 1 |
/// | velocity_verlet | 1 | 2 |
/// | heun | 2 | 2 |
/// | runge_kutta_4 | 4 | 4 |
struct Integrator {
  IntegratorId id;
  Real opening_kick = 0;  ///< duration of the kick before the drift, in step lengths
  /// Duration of the kick after the drift, in step lengths. The forces of the closing kick are also
  /// the forces of the opening kick of the next step.
  Real closing_kick = 0;
  void (*take_step)(const StepArguments& step) = nullptr;  ///< null: kicks and a drift

  bool keeps_forces() const { return closing_kick > 0; }
};

const Integrator& integrator_of(IntegratorId id);

/// The following functions take a step of an explicit Runge-Kutta method. In these methods, each
/// stage depends only on the start of the step and the preceding stage.
void take_explicit_euler_step(const StepArguments& step);
void take_heun_step(const StepArguments& step);
void take_runge_kutta_4_step(const StepArguments& step);

}  // namespace vat
