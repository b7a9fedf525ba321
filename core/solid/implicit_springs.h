#pragma once

#include <vector>

#include "core/evaluation/force_model.h"
#include "core/solid/spring_system.h"

namespace vat {

/// Returns whether a model has bodies with implicit springs.
inline bool has_implicit_springs(const Model& model) {
  return model.implicit_begin < model.free_count;
}

/// Buffers of implicit springs, for the particles from Model::implicit_begin on.
struct ImplicitSpringsScratch {
  SpringSystemScratch system;
  std::vector<Vec3> position;        ///< at the start
  std::vector<Vec3> start_velocity;  ///< at the start; after the drift, at the end
  std::vector<Vec3> mean_velocity;   ///< over the whole drift
  std::vector<Vec3> velocity;        ///< mean velocity: unknown of the solve
  std::vector<Vec3> last_velocity;
};

/// Moves bodies with implicit springs over the drift of velocity Verlet, in which no other force
/// acts. The method is unconditionally stable and of order 2. It conserves linear and angular
/// momentum up to rounding, and the energy of undamped springs up to kSpringTolerance.
///
/// Springs: x1 - x0 = dt (v0 + v1) / 2, m (v1 - v0) = dt f, with the force of a spring
///
///     f = -k (r - l + q (r1 - r0) / 2) (x0 + x1) / (2 r),   r = (r0 + r1) / 2
///
/// x is the difference of the two ends, and r0 and r1 are their distances before and after the
/// drift. For all steps, the work of a spring is k (r0 - l)^2 / 2 - k (r1 - l)^2 / 2 - q k (r1 -
/// r0)^2 / 2. The force acts along x0 + x1, so that angular momentum is conserved (q = 0: R. A.
/// LaBudde, D. Greenspan, Numer. Math. 25 (1976) 323; J. C. Simo, N. Tarnow, K. K. Wong, Comput.
/// Methods Appl. Mech. Eng. 100 (1992) 63; q > 0: F. Armero, I. Romero, Comput. Methods Appl. Mech.
/// Eng. 190 (2001) 2603). Undamped springs have q = 0. For damped springs, q = s^2 / (1 + s^2) with
/// s = dt c (1/m_a + 1/m_b). This value damps lengths that would otherwise oscillate although
/// dashpots end all motion within a step. The equations are solved by Newton's method, without the
/// transverse slopes of compressed springs. If Newton's method does not converge, the drift is
/// divided into two halves, down to 64 parts.
///
/// Forces other than springs are applied in half kicks before and after the drift. Only these
/// forces limit the step (A. Stern, E. Grinspun, Multiscale Model. Simul. 7 (2009) 1779).
///
/// The drift starts from the positions of store_implicit_positions() and from the velocities of the
/// configuration.
void drift_implicit_springs(const ForceModel& force_model, Configuration& configuration, Real dt,
                            ImplicitSpringsScratch& scratch);
/// Stores the positions of particles with implicit springs.
void store_implicit_positions(const Model& model, const Configuration& configuration,
                              ImplicitSpringsScratch& scratch);

/// Applies the dashpots to the velocities over `dt` [s], by an L-stable method of order 2 (R.
/// Alexander, SIAM J. Numer. Anal. 14 (1977) 1006). The method never adds energy, and conserves
/// linear and angular momentum up to rounding. It is applied half a step before the first kick and
/// half a step after the last kick. At these times, dashpots do not disturb the equilibrium of
/// loads and springs.
void damp_implicit_springs(const ForceModel& force_model, Configuration& configuration, Real dt,
                           ImplicitSpringsScratch& scratch);

/// Tolerance of the solve, relative to the change of velocities in the mass-weighted norm. The
/// rounding errors of very stiff springs may exceed it.
inline constexpr Real kSpringTolerance = 1e-6;

}  // namespace vat
