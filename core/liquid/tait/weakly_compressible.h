#pragma once

namespace vat {

struct StepContext;

/// Stages of the weakly compressible liquid: one kernel for density and force, Tait's equation of
/// state, a pressure force that derives from an energy, central viscosity.
///
/// With the rest volume V_i = m_i / rho_0 and s_i = rho_i / rho_0 = sum_j V_j W_ij over liquid,
/// solids and the walls' mirror images, the energy sum_i V_i u(s_i), du/ds = p / s^2, gives F_i =
/// -V_i sum_j V_j (p_i/s_i^2 + p_j/s_j^2) grad_i W_ij (J. J. Monaghan, Rep. Prog. Phys. 68 (2005)
/// 1703, sec. 3; rest volumes for masses allow liquids of different density). The kernel is scaled
/// so that a cubic lattice at rest has the rest density, and its gradient so that such a lattice
/// feels a pressure's slope in full: without, a column of liquid is up to 7 % too steep.
///
/// A wall of the vat is a mirror: the liquid's images complete it (A. Colagrossi, M. Landrini, J.
/// Comput. Phys. 191 (2003) 448), which keeps energy, with the weight between the two sides added
/// to the images' pressure. Along walls the liquid slips freely, but for no_slip ones
/// (core/liquid/pairs/viscous_images.h). Solid particles take part with their volumes, at rest
/// density, and with a pressure of their surroundings.

/// Into cells.
void sort_solids_in_liquid(StepContext& context);

/// Which liquid, solids and images may be near which liquid particles, and which liquid and images
/// of it near which solids. Of a collapsed liquid, where that is more than max_pair_work(), says so
/// in the workspace.
void find_pair_clusters(StepContext& context);

/// density = s_i rho_0. It is NaN after too many pairs, so that the step fails.
void compute_tait_density(StepContext& context);

/// p = rho_0 c^2/7 ((rho/rho_0)^7 - 1), linear in 1/rho from 1.03 rho_0 and in rho from 2 rho_0.
/// The pressure is at least zero (see compute_liquid_pressure()), with two exceptions: a liquid
/// that fills its world, and a cohesive liquid, whose minimum is -kTensileShare A/2 s^2
/// (core/liquid/surface/cohesion.h).
void compute_tait_pressure(StepContext& context);

/// The pressure of solid particles, from that of the liquid around them and the weight between (S.
/// Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012) 7057, eq. 27), with the same bound.
void extrapolate_pressure(StepContext& context);

/// The forces on liquid particles, and on the solids that push them.
void add_tait_forces(StepContext& context);
void add_tait_forces_on_solids(StepContext& context);

}  // namespace vat
