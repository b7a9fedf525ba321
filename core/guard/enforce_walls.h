#pragma once

#include "core/guard/guard.h"
#include "core/laws/vat_motion.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// A moment at the end of a step.
struct StepEnd {
  Real time;           ///< [s]
  std::uint64_t step;  ///< the nominal step that it belongs to
};

/// The planes behind the springs of the vat's walls. What a step took beyond one is put back, and
/// loses what of its velocity relative to the wall points outwards: the plane is hard, inelastic
/// and without friction, so relative to the vat kinetic energy never rises.
///
/// A free particle is put onto the plane. A rigid body is moved back as a whole by its greatest
/// depth, and an impulse along the normal stops the mean point of its particles that are beyond,
/// weighted by their depths. One that has turned too far to fit between two walls turns back to its
/// orientation in `before`, the start of the step, and has no spin. Fixed particles and held bodies
/// stay where they are.
///
/// Returns how many particles and rigid bodies were put back; where none was, `now` keeps its bits
/// (positions and velocities of rigid particles, which follow from the poses, may be brought up to
/// date). The result does not depend on the number of threads.
std::uint64_t enforce_walls(const Model& model, const GuardBounds& bounds, const StepEnd& end,
                            const Configuration& before, TaskRunner* runner, Configuration& now);

/// The same for the free particles before `count` alone.
std::uint64_t hold_particles_inside(const Model& model, Real time, std::size_t count,
                                    TaskRunner* runner, Configuration& now);

}  // namespace vat
