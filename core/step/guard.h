#pragma once

#include <optional>

#include "core/simulation.h"
#include "core/state/state.h"

namespace vat {

/// What is wrong with a state, and where.
struct Fault {
  GuardEvent::Cause cause;
  Index body;      ///< index into Model::bodies
  Index particle;  ///< within the body; 0 for a rigid body
};

/// Bounds that a sane state keeps.
struct GuardBounds {
  Vec3 min;        ///< of positions [m]
  Vec3 max;        ///< of positions [m]
  Real max_speed;  ///< [m/s]
};

/// With a vat: its box and twice its longest side around it, a hundred times above an open top.
/// Where particles can collide or meet walls, none may travel further in one step of `dt` than the
/// distance at which they notice.
GuardBounds guard_bounds(const Model& model, Real dt);

/// The first free particle or rigid body that is non-finite, out of bounds or too fast.
std::optional<Fault> find_fault(const Model& model, const Configuration& configuration,
                                const GuardBounds& bounds);

}  // namespace vat
