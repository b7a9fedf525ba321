#pragma once

namespace vat {

struct StepContext;

/// Stages of weakly compressible liquids that fill their world (Model::is_filled). Without a free
/// surface, pressure may be negative, which causes voids along streamlines. Particles therefore
/// move with a transport velocity u + w, with w such that their density becomes uniform (S. Adami,
/// X. Y. Hu, N. A. Adams, J. Comput. Phys. 241 (2013) 292).

/// w_i = -(c d / 6) sum_j V_j grad W_ij, for particles with the spacing d. (The background pressure
/// rho c^2 of the article would give c^2 dt, which is c d / 4 at its step limit. A smaller w
/// distorts the flow less, if particles do not start on a perfect lattice.)
void compute_transport_velocity(StepContext& context);

/// The momentum transport by w: the divergence of rho u w (eqs. 4 and 8 of the article), as V_i
/// sum_j V_j (rho_i u_i w_i + rho_j u_j w_j) . grad W_ij, which conserves momentum.
void add_transport_forces(StepContext& context);

}  // namespace vat
