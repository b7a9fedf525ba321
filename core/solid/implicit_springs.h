#pragma once

#include <vector>

#include "core/evaluation/force_model.h"
#include "core/solid/spring_system.h"

namespace vat {

/// Scratch of the drift of implicit springs. Entries are of the particles from
/// Model::implicit_begin on.
struct ImplicitSpringsScratch {
  SpringSystemScratch system;
  std::vector<Vec3> position;        ///< at the start
  std::vector<Vec3> start_velocity;  ///< and in the end that at the end
  std::vector<Vec3> mean_velocity;   ///< over the whole drift
  std::vector<Vec3> velocity;        ///< the mean one that is solved for
  std::vector<Vec3> last_velocity;
};

/// The motion of bodies with implicit springs over the drift of velocity Verlet, in which no other
/// force acts: unconditionally stable and of order 2. Linear and angular momentum are conserved
/// to rounding, the energy of undamped springs to kSpringTolerance.
///
/// Springs: x1 - x0 = dt (v0 + v1) / 2, m (v1 - v0) = dt f, where the force of a spring is
///
///     f = -k (r - l + q (r1 - r0) / 2) (x0 + x1) / (2 r),   r = (r0 + r1) / 2
///
/// with the differences x of its ends, and r0 and r1 their lengths. Whatever the step, it does the
/// work k (r0 - l)^2 / 2 - k (r1 - l)^2 / 2 - q k (r1 - r0)^2 / 2, and is along x0 + x1, so that
/// angular momentum stays (q = 0: R. A. LaBudde, D. Greenspan, Numer. Math. 25 (1976) 323; J. C.
/// Simo, N. Tarnow, K. K. Wong, Comput. Methods Appl. Mech. Eng. 100 (1992) 63; q > 0: F. Armero,
/// I. Romero, Comput. Methods Appl. Mech. Eng. 190 (2001) 2603). Undamped springs have q = 0; that
/// of others lets go of the lengths that would ring where dashpots end all motion within a step:
/// q = s^2 / (1 + s^2), s = dt c (1/m_a + 1/m_b). By Newton's method, without the slopes that
/// pressed springs have across; where it does not converge, the body's drift is taken in two
/// halves, down to 64 parts.
///
/// Between the half kicks of all other forces, such a method is limited by those alone (A. Stern,
/// E. Grinspun, Multiscale Model. Simul. 7 (2009) 1779).
///
/// From the places that keep_implicit_places() kept, with the velocities of the configuration.
void drift_implicit_springs(const ForceModel& force_model, Configuration& configuration, Real dt,
                            ImplicitSpringsScratch& scratch);
/// Keeps the places of particles with implicit springs.
void keep_implicit_places(const Model& model, const Configuration& configuration,
                          ImplicitSpringsScratch& scratch);

/// What the dashpots alone do to velocities in `dt`, by an L-stable method of order 2 (R.
/// Alexander, SIAM J. Numer. Anal. 14 (1977) 1006): it never adds energy, and conserves linear and
/// angular momentum to rounding. Half a step before the first kick and half a step after the last:
/// there it takes nothing from what loads and springs that balance each other do in between.
void damp_implicit_springs(const ForceModel& force_model, Configuration& configuration, Real dt,
                           ImplicitSpringsScratch& scratch);

/// Of the change of velocities, in the norm of the masses: what the solve may leave. Rounding of
/// very stiff springs may leave more.
inline constexpr Real kSpringTolerance = 1e-6;

}  // namespace vat
