#pragma once

#include <vector>

#include "core/incompressible/volume_solve.h"
#include "core/integrators/damping_solve.h"
#include "core/integrators/implicit_springs.h"
#include "core/projection/projection.h"
#include "core/scene/scene.h"
#include "core/state/state.h"
#include "core/step/force_model.h"

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

/// x += dt v for free particles, and the torque-free motion of rigid bodies.
void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
/// x += dt w of liquids that fill their world, see core/forces/transport.h.
void move_with_transport(const Model& model, TaskRunner* runner, const Forces& forces,
                         Configuration& configuration, Real dt);
/// v += dt f / m, P += dt f_res, L += dt tau.
void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt);

/// Explicit Runge-Kutta methods whose stages each need only the one before.
void take_runge_kutta_step(IntegratorId id, const ForceModel& force_model, State& state, Real time,
                           Real dt, IntegratorScratch& scratch);

}  // namespace vat
