#pragma once

#include <vector>

#include "core/contact/projection/contact_constraint.h"

namespace vat {

/// Contacts as constraints on positions (M. Mueller, M. Macklin, N. Chentanez, S. Jeschke,
/// T.-Y. Kim, Computer Graphics Forum 39 (2020) 101; M. Macklin et al., Symposium on Computer
/// Animation 2019): no stiffness, so no step is too long for them.
///
/// Where particles would overlap at the end of a step, impulses p at its start keep them apart:
///
///   x = x_0 + dt (v + p / m),   |x_i - x_j| >= l,   p >= 0,   p = 0 where they are apart,
///
/// which is the positions' correction dx = dt p / m after the drift, and v += dx / dt. They act
/// along the line between the two at the start (as those of SHAKE do: J.-P. Ryckaert, G. Ciccotti,
/// H. J. C. Berendsen, J. Comput. Phys. 23 (1977) 327), at one point of it, so that linear and
/// angular momentum are kept to rounding; a rigid body yields with 1/M + (a x n).I^-1 (a x n).
/// Friction lets nothing slip within the step, up to the limit of Coulomb's cone, |p_t| <= mu p:
/// what sticks does not creep.
///
/// After the kick that closes the step more are added at its end, until touching ends part with the
/// restitution times the speed at which they met, or rest. They may take back what pushing apart an
/// overlap added, but p stays at least 0 and p_t within the cone.
///
/// Both are solved for one contact after the other, there and back, until nothing changes: in the
/// contacts' order, on one thread.
class ContactProjection {
 public:
  /// Moves positions and poses on by `dt` from `time`.
  void drift(const ForceModel& force_model, Configuration& now, Real time, Real dt);
  /// Changes the velocities at the end of that step.
  void finish(const ForceModel& force_model, Configuration& now, Real time, Real dt);

 private:
  /// Where the velocities of start_ lead to.
  void predict(const ForceModel& force_model, Configuration& now, Real dt);

  ConstraintSearch search_;
  std::vector<ContactConstraint> constraints_;
  std::vector<RigidMotion> rigid_;      ///< as impulses change it
  std::vector<RigidMotion> predicted_;  ///< with which the poses were found
  Configuration start_;                 ///< of the step, its velocities as impulses change them
};

}  // namespace vat
