#pragma once

#include "core/evaluation/force_model.h"
#include "core/guard/guard.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Time at the end of a step.
struct StepEnd {
  Real time;           ///< [s]
  std::uint64_t step;  ///< nominal step that contains the step
};

/// Returns particles and bodies into the vat if a step has moved them beyond a wall. Removes the
/// outward part of their velocity relative to the wall. The wall is hard, inelastic and
/// frictionless, so that kinetic energy relative to the vat never increases.
///
/// A free particle is moved onto the wall. A particle of a coupled liquid is reflected to the
/// mirror image of its position. Its outward velocity is reversed if the liquid is weakly
/// compressible. A rigid body is translated by its maximum depth. The contact point is the depth-
/// weighted mean position of its particles beyond the wall. An impulse sets the normal velocity of
/// this point to zero. A body that has rotated too far to fit between two walls gets its
/// orientation from `before`, and zero angular velocity. `before` is the configuration at the start
/// of the step. Fixed particles and held bodies are not moved.
///
/// Returns the number of particles and rigid bodies that were moved. If this number is 0, `now` is
/// unchanged, except that positions and velocities of rigid particles may be updated from the
/// poses. The result does not depend on the number of threads.
std::uint64_t enforce_walls(const Model& model, const GuardBounds& bounds, const StepEnd& end,
                            const Configuration& before, TaskRunner* runner, Configuration& now);

/// Moves the free particles with indices below `count` back inside. Returns the number of moved
/// particles.
std::uint64_t enforce_walls_on_particles(const Model& model, Real time, std::size_t count,
                                         TaskRunner* runner, Configuration& now);

/// Moves liquid particles back inside at `time` [s], before the cells and pairs of their positions
/// are found. Adds the number of moved particles to ForceModel::report.
void hold_liquid_inside(const ForceModel& force_model, Real time, Configuration& now);

}  // namespace vat
