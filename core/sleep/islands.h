#pragma once

#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// Bodies that have come to rest sleep: they are not stepped until something may move them again.
///
/// Islands are bodies that are near each other: closer, particle by particle, than what follows. An
/// island falls asleep where all of its particles were slower than Sleeping::speed in every look,
/// one as each tick begins, for Sleeping::after, and nothing drives it. Its velocities become zero,
/// by which it loses at most m speed^2 / 2 of energy and m speed of momentum; its places stay. It
/// wakes, as a whole, before a step in which what is awake may come within reach of it.
///
/// The reach is the greatest distance at which particles of two bodies notice each other: that of
/// contacts or a liquid's support radius. In a step nothing moves further than the reach, see
/// core/guard/guard.h, or in varied steps than it goes in twice its length at its present speed:
/// at the reach and so much more sleepers wake. Islands are half a reach further apart, so that
/// what lies beside them without moving does not wake them.
namespace vat {

/// Of a body that is in no island that sleeps.
inline constexpr Index kAwake = ~Index{0};

/// [m] 0 where no body notices another.
Real greatest_reach(const Model& model);
/// How near something of this speed wakes what sleeps, in steps of `step` [m].
Real waking_distance(Real reach, Real speed, Real step);
/// How near bodies are of one island, or something awake keeps one awake [m].
Real island_distance(Real reach, Real speed, Real step);

/// The greatest speed of a body's particles [m/s]; of a rigid one's a bound. `limit`: above it the
/// answer may be any speed above it.
Real greatest_speed(const Model& model, const ModelBody& body, const Configuration& at, Real limit);

/// Has no particles, or is held for ever where it is: what lies on it is no island with it.
bool is_still(const Model& model, const ModelBody& body, const Configuration& at);

/// By body, the island in which it is to sleep, named by one of its bodies; kAwake for the others.
/// `rested`: by body, whether it has rested long enough and nothing drives it.
std::vector<Index> find_resting_islands(const Model& model, const Configuration& at,
                                        const std::vector<char>& rested);

}  // namespace vat
