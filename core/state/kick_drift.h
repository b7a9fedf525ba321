#pragma once

#include "core/state/state.h"

namespace vat {

/// Moves free particles by x += dt v, and rigid bodies without torque.
void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
/// The two parts of drift(): the particles of liquids, and all others.
void drift_liquids(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
void drift_solids(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
/// Moves the particles of liquids that fill their world by x += dt w; see
/// core/liquid/tait/transport.h.
void move_with_transport(const Model& model, TaskRunner* runner, const Forces& forces,
                         Configuration& configuration, Real dt);
/// Changes velocities and momenta by the forces: v += dt f / m, P += dt f_res, L += dt tau.
void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt);

}  // namespace vat
