#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Buffers of limit_elongation().
struct ElongationScratch {
  struct Limit {
    Vec3 direction;   ///< from the second end to the first one
    Real free_speed;  ///< separating speed up to which the spring is within its limit [m/s]
    Real mass;        ///< reduced mass of the ends [kg]; 0 for a torn spring
    Real impulse;     ///< that pulls the ends together, not negative [N s]
    Real gradient;    ///< change of the impulse in a round [N s]
    Real search;      ///< direction of the extrapolation [N s]
  };
  std::vector<Limit> limits;  ///< indexed by limited spring
  std::vector<Real> partial_sums;
};

/// Limits the elongation of springs in the following drift of `dt` [s]. X. Provot (Graphics
/// Interface 1995, pages 147-154) moves the ends of such springs. Here, the velocities change
/// before the drift, as in R. Bridson, R. Fedkiw, J. Anderson, ACM Trans. Graph. 21 (2002) 594. For
/// a spring that would exceed its limit, an impulse along the spring removes the excess of the
/// separating velocity of its ends. A spring that already exceeds its limit contracts. The impulses
/// only pull. They are inelastic, opposite and along the line between the ends, so that linear and
/// angular momentum are conserved up to rounding.
///
/// The impulses are the solution of a linear complementarity problem. Projected Gauss-Seidel sweeps
/// over the springs by colour, in order and in reverse order, change the accumulated impulses. The
/// nonlinear conjugate gradient method of M. Silcowitz-Hansen, S. Niebe, K. Erleben, The Visual
/// Computer 26 (2010) 893, extrapolates them between the sweeps. Sweeps end when no spring changes
/// by more than kElongationTolerance of its limit, and after kElongationSweeps at the latest.
///
/// The limit is linear in the motion along the spring. A spring that rotates by a small angle w dt
/// in the drift is elongated by (w dt)^2 / 2 of its length. The next step corrects this elongation.
///
/// Returns the number of sweeps.
int limit_elongation(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt,
                     ElongationScratch& scratch);
inline constexpr int kElongationSweeps = 100;
inline constexpr Real kElongationTolerance = 3e-4;

}  // namespace vat
