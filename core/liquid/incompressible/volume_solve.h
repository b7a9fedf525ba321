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
  std::vector<SolveReport> excess;     ///< by block of particles
};

/// Stage that sets the pressure to the pressure at the end of the last step.
void recall_pressure(StepContext& context);

// A step of an incompressible liquid contains a solve for velocities and a solve for positions. The
// solves correspond to the divergence-free and constant-density solves of J. Bender, D. Koschier,
// IEEE Trans. Vis. Comput. Graph. 23 (2017) 1193. Both solves are unilateral, because the liquid
// may separate.

/// Makes the velocities of liquids free of divergence, for a step of `dt` [s] from `time` [s] at
/// the present positions. Sets the velocity report in State::volume.
///
/// Let s = rho / rho_0, and let D and F be the rate and the force of PressureResponse. Impulses dt
/// F(p) with p >= 0 change the velocities of liquid and solids so that dt D_i(v) <= r_i. For s_i <
/// 1, the bound is r_i = (1 - s_i) / 4, which closes a quarter of a gap. For s_i >= 1, let e_i be
/// the excess of s_i - 1 over a tenth of the density tolerance. If e_i > 0, the bound is r_i =
/// -min(e_i, density tolerance, 0.0015). This bound removes excess density before positions must be
/// corrected, at a rate limited by the tolerance. A removal of all excess would cause noise in the
/// pressure of liquid at rest.
///
/// The forces already include the impulses of the last step. The solve therefore computes only the
/// change of the impulses. The divergence tolerance is at most a quarter of the density tolerance,
/// clamped to the range 0.001 to 0.003.
void project_velocities(const ForceModel& force_model, State& state, Real time, Real dt);

/// Moves liquid particles at the end of a step, at `time` [s], until the mean excess of s over 1 is
/// at most the density tolerance of the scene, and the greatest excess at most 36 times this value.
/// Each iteration of Newton's method solves D_i(shift) = 1 - s_i for the shift of the positions.
/// Sets the position report in State::volume.
///
/// The shifts do not change velocities (as in X. Y. Hu, N. A. Adams, J. Comput. Phys. 227 (2007)
/// 264), so that excess density adds no kinetic energy. Bodies that overlap initially therefore
/// separate without high velocities. Before the shifts, liquid beyond a wall is moved back, see
/// enforce_walls_on_particles().
void correct_density(const ForceModel& force_model, State& state, Real time);

}  // namespace vat
