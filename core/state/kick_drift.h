#pragma once

#include "core/state/state.h"

namespace vat {

/// x += dt v for free particles, and the torque-free motion of rigid bodies.
void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);
/// x += dt w of liquids that fill their world, see core/liquid/tait/transport.h.
void move_with_transport(const Model& model, TaskRunner* runner, const Forces& forces,
                         Configuration& configuration, Real dt);
/// v += dt f / m, P += dt f_res, L += dt tau.
void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt);

}  // namespace vat
