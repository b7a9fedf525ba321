#pragma once

#include <optional>
#include <vector>

#include "core/stage/advance_report.h"
#include "core/state/state.h"

namespace vat {

/// A fault that find_fault() has found in a state.
struct Fault {
  GuardEvent::Cause cause;
  Index body;      ///< index into Model::bodies
  Index particle;  ///< index within the body; 0 for a rigid body
};

/// Bounds of valid states.
struct GuardBounds {
  Vec3 min;  ///< minimum of positions [m]
  Vec3 max;  ///< maximum of positions [m]
  /// For each body, the maximum displacement of its particles in one step [m]. For a coupled
  /// liquid, the limit is half its support radius. For any other body, the limit is the minimum
  /// distance at which one of its particles interacts with a wall or another body. A particle with
  /// a greater displacement could pass through a body without a contact.
  std::vector<Real> travel;
  /// For each rigid body, the distance from the centre of mass to the farthest particle [m].
  std::vector<Real> extent;
  /// For each rigid body, half the edge lengths of the bounding box of its particle centres [m], in
  /// body axes.
  std::vector<Vec3> half_sizes;
};

/// Returns the bounds of `model`. With a vat, the domain is the box of the vat, extended by twice
/// its longest side, and by 100 times this side above an open top. The domain is unbounded along
/// axes without walls.
GuardBounds guard_bounds(const Model& model);

/// Returns the first particle or rigid body that is non-finite, out of bounds, or too fast. The
/// speed limits are kMaxSpeed, GuardBounds::travel per step of `dt` [s], and a rotation of one
/// radian per step.
std::optional<Fault> find_fault(const Model& model, const Configuration& configuration,
                                const GuardBounds& bounds, Real dt, TaskRunner* runner = nullptr);

}  // namespace vat
