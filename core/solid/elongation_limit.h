#pragma once

#include "core/model/model.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Limits the elongation of springs in the following drift of `dt` [s]. X. Provot (Graphics
/// Interface 1995, pages 147-154) moves the ends of such springs. Here, the velocities change
/// before the drift, as in R. Bridson, R. Fedkiw, J. Anderson, ACM Trans. Graph. 21 (2002) 594. For
/// a spring that would exceed its limit, an impulse along the spring removes the excess of the
/// separating velocity of its ends. A spring that already exceeds its limit contracts. The impulses
/// are inelastic, opposite and along the line between the ends, so that linear and angular momentum
/// are conserved up to rounding. The springs are processed by colour, in at most kElongationSweeps
/// sweeps. Sweeps end when all springs are within kElongationTolerance of their limit.
///
/// The limit is linear in the motion along the spring. A spring that rotates by a small angle w dt
/// in the drift is elongated by (w dt)^2 / 2 of its length. The next step corrects this elongation.
void limit_elongation(const Model& model, TaskRunner* runner, Configuration& configuration,
                      Real dt);
inline constexpr int kElongationSweeps = 100;
inline constexpr Real kElongationTolerance = 1e-4;

}  // namespace vat
