#pragma once

#include <optional>
#include <vector>

#include "core/stage/advance_report.h"
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
  Vec3 min;  ///< of positions [m]
  Vec3 max;  ///< of positions [m]
  /// By body: how far its particles may move in one step, the least distance at which one of them
  /// notices a wall or a particle of another body [m]. Further, it could pass through unnoticed.
  std::vector<Real> travel;
  /// By rigid body: from the centre of mass to the furthest particle [m].
  std::vector<Real> extent;
  /// By rigid body: half the sides of a box about its particles' centres, in body axes [m].
  std::vector<Vec3> half_sizes;
};

/// The domain is, with a vat, its box and twice its longest side around it, a hundred times above
/// an open top, and everything along axes without walls.
GuardBounds guard_bounds(const Model& model);

/// The first particle or rigid body that is non-finite, out of bounds, or too fast for steps of
/// `dt`: above kMaxSpeed, above its travel, or, of rigid bodies, turning by more than a radian.
std::optional<Fault> find_fault(const Model& model, const Configuration& configuration,
                                const GuardBounds& bounds, Real dt, TaskRunner* runner = nullptr);

}  // namespace vat
