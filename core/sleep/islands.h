#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// Bodies at rest sleep: they are not stepped until something can move them again.
///
/// Islands are sets of bodies that are near each other: their particles are within the island
/// distance. Each tick checks the speeds. An island falls asleep if all its particles were slower
/// than Sleeping::speed during the time Sleeping::after and nothing acts on it. Its velocities
/// become zero, which removes at most m speed^2 / 2 of energy and m speed of momentum; its
/// positions remain constant. An island wakes as a whole before a step in which an awake body can
/// come within reach of it.
///
/// The reach is the maximum distance at which particles of two bodies interact: that of contacts or
/// the support radius of a liquid. In one fixed step, a body moves at most by the reach (see
/// core/guard/guard.h). In adaptive and local steps, it moves at most by its present speed times
/// twice the nominal step. Sleepers wake at the sum of the reach and this distance. The island
/// distance is half a reach longer, so that bodies that lie beside an island without moving do not
/// wake it.
namespace vat {

/// The island of a body that is awake.
inline constexpr Index kAwake = ~Index{0};

/// The reach [m]; 0 if bodies do not interact.
Real greatest_reach(const Model& model);
/// Returns the distance at which a body with this speed wakes a sleeper, for steps of `step` [m].
Real waking_distance(Real reach, Real speed, Real step);
/// Returns the maximum distance between neighbours in an island [m]. An awake body within this
/// distance keeps a body awake.
Real island_distance(Real reach, Real speed, Real step);

/// The maximum speed of a body's particles [m/s]; for a rigid body an upper bound. If the maximum
/// exceeds `limit`, the result may be any speed between `limit` and the maximum.
Real greatest_speed(const Model& model, const ModelBody& body, const Configuration& at, Real limit);

/// Returns whether the body has no particles, or is held for all time without motion. Bodies that
/// lie on it form no island with it.
bool is_still(const Model& model, const ModelBody& body, const Configuration& at);

/// For each body, the island in which it can sleep, identified by one of its bodies; kAwake for the
/// others. `rested`: for each body, whether it has rested long enough and nothing acts on it.
std::vector<Index> find_resting_islands(const Model& model, const Configuration& at,
                                        const std::vector<char>& rested);

}  // namespace vat
