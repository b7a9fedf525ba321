#pragma once

#include "core/contact/projection/projection.h"
#include "core/damping/damping_solve.h"
#include "core/evaluation/force_model.h"
#include "core/scene/scene.h"
#include "core/solid/implicit_springs.h"
#include "core/state/state.h"

namespace vat {

/// Buffers of integrators, kept between steps.
struct IntegratorScratch {
  Configuration start;
  Configuration increment;  ///< weighted sum of the rates of a Runge-Kutta method
  DampingScratch damping;
  ImplicitSpringsScratch implicit_springs;
  ContactProjection projection;
};

/// The arguments of a step of an integrator. Each stage of a step evaluates forces that are
/// functions of its configuration and time.
struct StepArguments {
  const ForceModel& force_model;
  State& state;
  Real time;  ///< start of the step [s]
  Real dt;    ///< length of the step [s]
  IntegratorScratch& scratch;
};

/// A time integrator: kicks around a drift, or a function that takes the whole step. Free particles
/// and rigid bodies advance together.
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
  Real opening_kick = 0;  ///< before the drift, in step lengths
  Real closing_kick = 0;  ///< after the drift, in step lengths; its forces open the next step
  void (*take_step)(const StepArguments& step) = nullptr;  ///< null: a step is kicks and a drift

  bool keeps_forces() const { return closing_kick > 0; }
};

const Integrator& integrator_of(IntegratorId id);

/// Explicit Runge-Kutta methods in which each stage needs only the preceding one.
void take_explicit_euler_step(const StepArguments& step);
void take_heun_step(const StepArguments& step);
void take_runge_kutta_4_step(const StepArguments& step);

}  // namespace vat
