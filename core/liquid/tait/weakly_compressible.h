#pragma once

#include <vector>

#include "core/liquid/pairs/pair_sums.h"
#include "core/types.h"

namespace vat {

struct StepContext;

/// Stages of weakly compressible liquids. The method uses one kernel for density and force, and
/// Tait's equation of state. The pressure force derives from an energy. The viscous force acts
/// along the line between two particles.
///
/// The rest volume is V_i = m_i / rho_0, and the relative density is s_i = rho_i / rho_0 = sum_j
/// V_j W_ij. The sum is over liquid, solids and images in walls. The energy sum_i V_i u(s_i) with
/// du/ds = p / s^2 leads to F_i = -V_i sum_j V_j (p_i/s_i^2 + p_j/s_j^2) grad_i W_ij (J. J.
/// Monaghan, Rep. Prog. Phys. 68 (2005) 1703, sec. 3). Rest volumes in place of masses allow
/// liquids of different densities. The kernel is scaled so that a cubic lattice at rest has the
/// rest density. The kernel gradient is scaled so that the force on a lattice by a pressure
/// gradient is exact. Without this scaling of the gradient, the pressure gradient in a liquid at
/// rest under gravity would be up to 7 % too large.
///
/// A wall of the vat is a mirror. The images of liquid particles complete the sums near walls (A.
/// Colagrossi, M. Landrini, J. Comput. Phys. 191 (2003) 448) and conserve energy. The pressure of
/// an image includes the hydrostatic pressure difference between the particle and the image. The
/// liquid slips along walls without friction, except along no_slip walls
/// (core/liquid/pairs/viscous_images.h). In the sums, solid particles have their volumes, the rest
/// density, and the pressure of the surrounding liquid.

/// Stage that sorts solid particles into cells.
void sort_solids_in_liquid(StepContext& context);

/// Stage that finds the liquid, solids and images near liquid particles, and the liquid and its
/// images near solid particles. Sets too_many_pairs if a collapsed liquid exceeds max_pair_work().
void find_pair_clusters(StepContext& context);

/// Stage that sets the density to s_i rho_0. If there are too many pairs, sets one density to NaN,
/// so that the step fails.
void compute_tait_density(StepContext& context);

/// Stage that sets the pressure to p = rho_0 c^2/7 ((rho/rho_0)^7 - 1) up to 1.03 rho_0. The
/// pressure is linear in 1/rho up to 2 rho_0, and linear in rho above. The pressure is at least
/// zero (see compute_liquid_pressure()), with two exceptions. A liquid that fills its world has no
/// minimum. A cohesive liquid has the minimum -kTensileShare A/2 s^2
/// (core/liquid/surface/cohesion.h).
void compute_tait_pressure(StepContext& context);

/// Stage that extrapolates the pressure of the surrounding liquid to solid particles, including the
/// hydrostatic pressure difference (S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012)
/// 7057, eq. 27). The pressure is at least zero, except in a liquid that fills its world.
void extrapolate_pressure(StepContext& context);

/// Stages that add the pressure and viscous forces on liquid particles and on solid particles. The
/// forces on liquid include those of add_viscous_image_forces() if is_dragged_by_all_images().
void add_tait_forces(StepContext& context);
void add_tait_forces_on_solids(StepContext& context);

/// Add the sums `sum` (PairSums::pressure or PairSums::force) with the present motions of the
/// sources, as forces on liquid particles and on solid particles, to `force`. If
/// is_dragged_by_all_images(), PairSums::force includes the forces of images.
void add_pair_forces(const StepContext& context, PairSums::Function sum, std::vector<Vec3>& force);
void add_pair_forces_on_solids(const StepContext& context, PairSums::Function sum,
                               std::vector<Vec3>& force);

}  // namespace vat
