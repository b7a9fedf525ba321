#pragma once

#include <optional>
#include <vector>

#include "core/stage/advance_report.h"
#include "core/state/state.h"

namespace vat {

/// A fault of a state, with its body and particle.
struct Fault {
  GuardEvent::Cause cause;
  Index body;      ///< index into Model::bodies
  Index particle;  ///< within the body; 0 for a rigid body
};

/// Bounds of valid states.
struct GuardBounds {
  Vec3 min;  ///< of positions [m]
  Vec3 max;  ///< of positions [m]
  /// For each body, the maximum displacement of its particles in one step [m]. It equals the
  /// minimum distance at which one of the particles interacts with a wall or another body. A faster
  /// particle could pass through without a contact.
  std::vector<Real> travel;
  /// For each rigid body, the distance from the centre of mass to the farthest particle [m].
  std::vector<Real> extent;
  /// For each rigid body, half the sides of the box of its particle centres, in body axes [m].
  std::vector<Vec3> half_sizes;
};

/// Returns the bounds of `model`. With a vat, the domain is its box, extended by twice its longest
/// side, and by 100 times that side above an open top. It is unbounded along axes without walls.
GuardBounds guard_bounds(const Model& model);

/// Returns the first particle or rigid body that is non-finite, out of bounds, or too fast. The
/// speed limits are kMaxSpeed, GuardBounds::travel per step of `dt`, and a rotation of one radian
/// per step.
std::optional<Fault> find_fault(const Model& model, const Configuration& configuration,
                                const GuardBounds& bounds, Real dt, TaskRunner* runner = nullptr);

}  // namespace vat
