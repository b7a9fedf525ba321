#pragma once

#include "core/state/state.h"

namespace vat {

/// Free particles: x += dt v. Rigid bodies: motion without torque.
void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
/// Liquids that fill their world: x += dt w; see core/liquid/tait/transport.h.
void move_with_transport(const Model& model, TaskRunner* runner, const Forces& forces,
                         Configuration& configuration, Real dt);
/// v += dt f / m, P += dt f_res, L += dt tau.
void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt);

}  // namespace vat
