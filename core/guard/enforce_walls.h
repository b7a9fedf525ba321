#pragma once

#include "core/guard/guard.h"
#include "core/laws/vat_motion.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// The end of a step.
struct StepEnd {
  Real time;           ///< [s]
  std::uint64_t step;  ///< the nominal step to which it belongs
};

/// Moves back particles and bodies that a step took beyond a wall of the vat. They lose the outward
/// part of their velocity relative to the wall: the wall is hard, inelastic and frictionless, so
/// that kinetic energy relative to the vat never increases.
///
/// A free particle is moved onto the wall. A rigid body is moved back as a whole by its maximum
/// depth. An impulse along the normal stops the mean point of its particles beyond the wall,
/// weighted by their depths. A body that has rotated too far to fit between two walls gets its
/// orientation of `before`, the start of the step, and no spin. Fixed particles and held bodies are
/// not moved.
///
/// Returns the number of particles and rigid bodies that were moved. If this number is 0, `now` is
/// unchanged, except that positions and velocities of rigid particles may be updated from the
/// poses. The result does not depend on the number of threads.
std::uint64_t enforce_walls(const Model& model, const GuardBounds& bounds, const StepEnd& end,
                            const Configuration& before, TaskRunner* runner, Configuration& now);

/// Moves back the free particles with indices below `count`.
std::uint64_t enforce_walls_on_particles(const Model& model, Real time, std::size_t count,
                                         TaskRunner* runner, Configuration& now);

}  // namespace vat
