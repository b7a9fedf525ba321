#pragma once

namespace vat {

struct StepContext;

/// Stages of weakly compressible liquids that fill their world (Model::is_filled). Without a free
/// surface pressure may be negative, which tears voids into the liquid along its streamlines; so
/// particles are moved with a transport velocity u + w, in which w evens out their density (S.
/// Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 241 (2013) 292).

/// w_i = -(c d / 6) sum_j V_j grad W_ij, for particles d apart. (The article's background pressure
/// rho c^2 would make it c^2 dt, which is c d / 4 at its step limit; less leaves more of a flow's
/// own motion, as long as particles begin off a perfect lattice.)
void compute_transport_velocity(StepContext& context);

/// What momentum is carried along with w: the divergence of rho u w (eqs. 4 and 8 of the article),
/// as V_i sum_j V_j (rho_i u_i w_i + rho_j u_j w_j) . grad W_ij, which keeps momentum.
void add_transport_forces(StepContext& context);

}  // namespace vat
