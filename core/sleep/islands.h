#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// Sleep of resting bodies. Sleeping bodies are not stepped until other bodies can move them.
///
/// An island is a set of bodies that are near each other: the distance between their particles is
/// below the island distance. Speeds are checked once per tick. An island falls asleep if all its
/// particles were slower than Sleeping::speed for the duration Sleeping::after and nothing acts on
/// it. Sleep sets its velocities to zero, which removes at most m speed^2 / 2 of energy and m speed
/// of momentum. Its positions remain constant. An island wakes as a whole before a step in which an
/// awake body can enter its reach.
///
/// The reach is the maximum distance at which particles of two bodies interact: the reach of
/// contacts or the support radius of a liquid. In one fixed step, a body moves at most by the reach
/// (see core/guard/guard.h). In adaptive and local steps, a body moves at most by its current speed
/// times twice the nominal step. Sleepers wake at the sum of the reach and this distance. The
/// island distance is half a reach longer, so that motionless bodies beside an island do not wake
/// it.
namespace vat {

/// Value for a body that is awake, in place of an island.
inline constexpr Index kAwake = ~Index{0};

/// Returns the reach [m]. The result is 0 if bodies do not interact.
Real greatest_reach(const Model& model);
/// Returns the distance [m] at which a body with this speed wakes a sleeper, for steps of `step`
/// [s].
Real waking_distance(Real reach, Real speed, Real step);
/// Returns the maximum distance between neighbours in an island [m]. A body within this distance of
/// an awake body does not sleep.
Real island_distance(Real reach, Real speed, Real step);

/// Returns the maximum speed of a body's particles [m/s], or an upper bound for a rigid body. If
/// the maximum exceeds `limit`, the result may be any speed between `limit` and the maximum.
Real greatest_speed(const Model& model, const ModelBody& body, const Configuration& at, Real limit);

/// Returns whether the body has no particles, or is held for all time without motion. Bodies that
/// rest on such a body form no island with it.
bool is_still(const Model& model, const ModelBody& body, const Configuration& at);

/// Returns for each body the island in which it can sleep, identified by one body of the island, or
/// kAwake. `rested` states for each body whether it has rested for the required duration and
/// nothing acts on it.
std::vector<Index> find_resting_islands(const Model& model, const Configuration& at,
                                        const std::vector<char>& rested);

}  // namespace vat
