#pragma once

#include "core/model/model.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Before a drift of `dt`: no spring with an elongation limit gets longer than it may be (after X.
/// Provot, Graphics Interface 1995, pages 147-154, who moves the ends of such springs; here their
/// velocities change before they move, as in R. Bridson, R. Fedkiw, J. Anderson, ACM Trans. Graph.
/// 21 (2002) 594). What would be longer loses by an impulse along it what is too much of the speed
/// at which its ends part, or closes where it is too long already. Impulses are opposite and along
/// the line between both ends, so that linear and angular momentum stay to rounding, and inelastic.
/// One spring after the other, colour by colour, in at most kElongationSweeps rounds, until none is
/// above its limit by kElongationTolerance of its length.
///
/// The limit is that of the motion along the spring: a spring that turns by a small angle w dt in
/// the drift gets longer by (w dt)^2 / 2 of its length, which the next step takes back.
void limit_elongation(const Model& model, TaskRunner* runner, Configuration& configuration,
                      Real dt);
inline constexpr int kElongationSweeps = 100;
inline constexpr Real kElongationTolerance = 1e-4;

}  // namespace vat
