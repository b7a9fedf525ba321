#pragma once

namespace vat {

struct StepContext;

/// Stages of weakly compressible liquids that fill their world (Model::is_filled). In these
/// liquids, pressures may be negative, which causes voids along streamlines. Particles therefore
/// move with a transport velocity u + w instead of their velocity u. The additional velocity w
/// makes the particle density uniform (S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 241 (2013)
/// 292).

/// Stage that computes w_i = -(c d / 6) sum_j V_j grad W_ij [m/s] for the speed of sound c and the
/// particle spacing d. With the background pressure rho c^2 of the article, the factor would be c^2
/// dt, which is c d / 4 at the article's step limit. A smaller w distorts the flow less if the
/// initial positions are not a perfect lattice.
void compute_transport_velocity(StepContext& context);

/// Stage that adds the momentum transport by w, which is the divergence of rho u w (eqs. 4 and 8 of
/// the article). The force is V_i sum_j V_j (rho_i u_i w_i + rho_j u_j w_j) . grad W_ij, which
/// conserves momentum.
void add_transport_forces(StepContext& context);

}  // namespace vat
