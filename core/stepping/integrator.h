#pragma once

#include <vector>

#include "core/contact/projection/projection.h"
#include "core/damping/damping_solve.h"
#include "core/evaluation/force_model.h"
#include "core/liquid/incompressible/volume_solve.h"
#include "core/scene/scene.h"
#include "core/solid/implicit_springs.h"
#include "core/state/kick_drift.h"
#include "core/state/state.h"

namespace vat {

/// Arrays kept between steps by the methods that need them.
struct IntegratorScratch {
  Configuration start;
  Configuration increment;  ///< weighted sum of a Runge-Kutta method's rates
  DampingScratch damping;   ///< of velocity Verlet, as are implicit springs
  ImplicitSpringsScratch implicit_springs;
  ContactProjection projection;
  VolumeScratch volume;
};

/// One step of `dt` seconds from `time`. Free particles and rigid bodies advance together, and
/// every stage sees forces that are functions of its own configuration and time.
///
/// | method | force evaluations | order |
/// |---|---|---|
/// | explicit_euler | 1 | 1 |
/// | symplectic_euler | 1 | 1 |
/// | velocity_verlet | 1 | 2 |
/// | heun | 2 | 2 |
/// | runge_kutta_4 | 4 | 4 |
void take_step(IntegratorId id, const ForceModel& force_model, State& state, Real time, Real dt,
               IntegratorScratch& scratch);

/// Explicit Runge-Kutta methods whose stages each need only the one before.
void take_runge_kutta_step(IntegratorId id, const ForceModel& force_model, State& state, Real time,
                           Real dt, IntegratorScratch& scratch);

}  // namespace vat
