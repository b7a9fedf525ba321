#pragma once

namespace vat {

struct StepContext;

/// Stages of weakly compressible liquids. The method uses one kernel for density and force, Tait's
/// equation of state, a pressure force derived from an energy, and central viscosity.
///
/// With the rest volume V_i = m_i / rho_0 and s_i = rho_i / rho_0 = sum_j V_j W_ij over liquid,
/// solids and the mirror images in walls, the energy sum_i V_i u(s_i), du/ds = p / s^2, leads to
/// F_i = -V_i sum_j V_j (p_i/s_i^2 + p_j/s_j^2) grad_i W_ij (J. J. Monaghan, Rep. Prog. Phys. 68
/// (2005) 1703, sec. 3; rest volumes in place of masses allow liquids of different densities). The
/// kernel is scaled so that a cubic lattice at rest has the rest density. Its gradient is scaled so
/// that the lattice has the exact force of a pressure gradient. Without this scaling, the pressure
/// gradient in a liquid column is up to 7 % too large.
///
/// A wall of the vat is a mirror. The images of the liquid complete the sums (A. Colagrossi, M.
/// Landrini, J. Comput. Phys. 191 (2003) 448) and conserve energy. The hydrostatic pressure
/// difference between a particle and its image is added to the pressure of the image. Along walls
/// the liquid slips without friction, except along no_slip walls
/// (core/liquid/pairs/viscous_images.h). Solid particles take part with their volumes, the rest
/// density, and the pressure of the surrounding liquid.

/// Sorts solids into cells.
void sort_solids_in_liquid(StepContext& context);

/// Finds the liquid, solids and images near liquid particles, and the liquid and its images near
/// solids. Sets too_many_pairs if a collapsed liquid exceeds max_pair_work().
void find_pair_clusters(StepContext& context);

/// density = s_i rho_0. One density is NaN after too many pairs, so that the step fails.
void compute_tait_density(StepContext& context);

/// p = rho_0 c^2/7 ((rho/rho_0)^7 - 1), linear in 1/rho from 1.03 rho_0 and in rho from 2 rho_0.
/// The pressure is at least zero (see compute_liquid_pressure()), with two exceptions: a liquid
/// that fills its world, and a cohesive liquid, whose minimum is -kTensileShare A/2 s^2
/// (core/liquid/surface/cohesion.h).
void compute_tait_pressure(StepContext& context);

/// Computes the pressure of solid particles from that of the surrounding liquid and the hydrostatic
/// difference between both (S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012) 7057, eq.
/// 27). The minimum is that of compute_tait_pressure().
void extrapolate_pressure(StepContext& context);

/// These stages add the forces: add_tait_forces() on liquid particles, add_tait_forces_on_solids()
/// on solids.
void add_tait_forces(StepContext& context);
void add_tait_forces_on_solids(StepContext& context);

}  // namespace vat
