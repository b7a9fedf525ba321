#pragma once

#include "core/evaluation/force_model.h"
#include "core/liquid/incompressible/complementarity.h"
#include "core/liquid/incompressible/pressure_response.h"

namespace vat {

/// Kept between steps, so that a steady one allocates nothing.
struct VolumeScratch {
  ResponseScratch response;
  Complementarity problem;
  std::vector<Real> relative_density;  ///< by slot
};

/// The pressure that the last step ended with.
void recall_pressure(StepContext& context);

// A step of an incompressible liquid ends with two solves, for the velocities and for the places:
// the divergence-free and the constant-density solve of J. Bender and D. Koschier (IEEE Trans. Vis.
// Comput. Graph. 23 (2017) 1193), both unilateral, for the liquid may come apart.

/// Makes the velocities, over a step of `dt` that begins at `time` in the present places, those of
/// an incompressible liquid.
///
/// With s = rho / rho_0 and the rate D of PressureResponse, impulses dt F(p), p >= 0, change the
/// velocities of liquid and solids until dt D_i(v) <= r_i. Where s_i < 1, r_i = (1 - s_i) / 2: half
/// of a gap is closed. Where s_i is above 1 by more than a fifth of the density tolerance, the rest
/// of it, the tolerance at most, makes r_i negative: what steps leave too dense is undone before
/// the places need it, with a speed that the tolerance bounds. Closer to 1 liquid at rest hovers,
/// and undoing that would be noise in its pressure. Impulses of the last step are part of the
/// forces already; only the difference is solved for.
SolveReport project_velocities(const ForceModel& force_model, Configuration& now, Real time,
                               Real dt, VolumeScratch& scratch);

/// Moves liquid that is too dense in the places at a step's end, the time `time`, until s <= 1 but
/// for the scene's density tolerance, measured and not by linear theory: Newton's method, with a
/// shift by D_i(shift) = 1 - s_i in each of its rounds.
///
/// The shifts leave velocities alone (as in X. Y. Hu, N. A. Adams, J. Comput. Phys. 227 (2007)
/// 264), so that places that are too dense give no energy: what overlaps at a start makes room, and
/// does not explode. What has passed a wall is put back first, see hold_particles_inside().
SolveReport correct_density(const ForceModel& force_model, Configuration& now, Real time,
                            VolumeScratch& scratch);

}  // namespace vat
