#pragma once

#include <vector>

#include "core/contact/projection/contact_constraint.h"

namespace vat {

/// Contacts as constraints on positions (M. Mueller, M. Macklin, N. Chentanez, S. Jeschke, T.-Y.
/// Kim, Computer Graphics Forum 39 (2020) 101; M. Macklin et al., Symposium on Computer Animation
/// 2019). They have no stiffness and do not limit the step.
///
/// If particles would overlap at the end of a step, impulses p at its start separate them:
///
///   x = x_0 + dt (v + p / m),   |x_i - x_j| >= l,   p >= 0,   p = 0 for separate particles,
///
/// which is the correction dx = dt p / m of positions after the drift, and v += dx / dt. The
/// impulses act along the line between both particles at the start (as those of SHAKE: J.-P.
/// Ryckaert, G. Ciccotti, H. J. C. Berendsen, J. Comput. Phys. 23 (1977) 327), at one point of it,
/// so that linear and angular momentum are conserved up to rounding. The mobility of a rigid body
/// is 1/M + (a x n).I^-1 (a x n). Friction prevents slip within the step, up to the limit of
/// Coulomb's cone, |p_t| <= mu p; sticking contacts do not creep.
///
/// After the closing kick of the step, further impulses at its end give touching particles the
/// separation speed restitution times approach speed, or rest. They may cancel the speed that the
/// separation of an overlap has added, but p remains at least 0 and p_t within the cone.
///
/// Both solves process one contact after another in both orders until none changes, in the order of
/// the contacts and on one thread.
class ContactProjection {
 public:
  /// Moves positions and poses by `dt` from `time`.
  void drift(const ForceModel& force_model, Configuration& now, Real time, Real dt);
  /// Changes the velocities at the end of this step.
  void finish(const ForceModel& force_model, Configuration& now, Real time, Real dt);

 private:
  /// Moves `now` with the velocities of start_.
  void predict(const ForceModel& force_model, Configuration& now, Real dt);

  ConstraintSearch search_;
  std::vector<ContactConstraint> constraints_;
  std::vector<RigidMotion> rigid_;      ///< present motion, changed by impulses
  std::vector<RigidMotion> predicted_;  ///< motion of the predicted poses
  Configuration start_;                 ///< of the step, with the velocities that impulses change
};

}  // namespace vat
