#pragma once

#include "core/evaluation/force_model.h"
#include "core/liquid/incompressible/complementarity.h"
#include "core/liquid/incompressible/pressure_response.h"

namespace vat {

/// Buffers of the solves of incompressible liquids.
struct VolumeScratch {
  static constexpr Method kMethod = Method::incompressible;

  ResponseScratch response;
  Complementarity problem;
  std::vector<Real> relative_density;  ///< by slot
};

/// Stage: sets the pressure to that at the end of the last step.
void recall_pressure(StepContext& context);

// A step of an incompressible liquid contains two solves, for velocities and for positions: the
// divergence-free and the constant-density solve of J. Bender and D. Koschier (IEEE Trans. Vis.
// Comput. Graph. 23 (2017) 1193). Both are unilateral, because the liquid may separate.

/// Makes the velocities those of an incompressible liquid, for a step of `dt` from `time` at the
/// present positions. Sets the report of the velocities.
///
/// With s = rho / rho_0 and the rate D of PressureResponse, impulses dt F(p), p >= 0, change the
/// velocities of liquid and solids until dt D_i(v) <= r_i. For s_i < 1, r_i = (1 - s_i) / 2, which
/// closes half of a gap. Let e_i be the part of s_i - 1 above a fifth of the density tolerance. If
/// e_i > 0, r_i = -min(e_i, density tolerance, 0.0015). This removes the excess density of steps
/// before positions must be corrected, with a speed that the tolerance limits. In liquid at rest, s
/// fluctuates by less than this fifth of the tolerance; removing these fluctuations would cause
/// noise in the pressure. The forces already include the impulses of the last step, so that only
/// the difference is solved. A divergence tolerance is limited to a quarter of the density
/// tolerance; this bound is at least 0.001 and at most 0.01.
void project_velocities(const ForceModel& force_model, State& state, Real time, Real dt);

/// Moves liquid with excess density at the end of a step, at `time`, until the measured s is at
/// most 1 within the scene's density tolerance. Uses Newton's method; each round solves D_i(shift)
/// = 1 - s_i for the shift. Sets the report of the positions.
///
/// The shifts do not change velocities (as in X. Y. Hu, N. A. Adams, J. Comput. Phys. 227 (2007)
/// 264), so that excess density adds no energy: bodies that overlap at the start separate without
/// an explosion. Liquid beyond a wall is moved back first, see enforce_walls_on_particles().
void correct_density(const ForceModel& force_model, State& state, Real time);

}  // namespace vat
