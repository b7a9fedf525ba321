#pragma once

#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/contact/projection/contact_islands.h"
#include "core/contact/projection/contact_solve.h"

namespace vat {

/// Contacts by projection, which are constraints on positions (M. Mueller, M. Macklin, N.
/// Chentanez, S. Jeschke, T.-Y. Kim, Computer Graphics Forum 39 (2020) 101; M. Macklin et al.,
/// Symposium on Computer Animation 2019). Contacts by projection have no stiffness and do not limit
/// the step.
///
/// If particles would overlap at the end of a step, impulses p at the start of the step separate
/// the particles:
///
///   x = x_0 + dt (v + p / m),   |x_i - x_j| >= l,   p >= 0,   p = 0 for separate particles,
///
/// This is equivalent to the correction dx = dt p / m of the positions after the drift, and v += dx
/// / dt. The impulses act at one point of the line between both particles at the start of the step,
/// and along this line, as in SHAKE (J.-P. Ryckaert, G. Ciccotti, H. J. C. Berendsen, J. Comput.
/// Phys. 23 (1977) 327). Linear and angular momentum are therefore conserved up to rounding. The
/// mobility of a rigid body is 1/M + (a x n).I^-1 (a x n) for the normal n and the arm a. Friction
/// prevents slip within the step, up to the limit of Coulomb's cone, |p_t| <= mu p. Sticking
/// contacts therefore do not creep.
///
/// After the closing kick, impulses at the end of the step set the separation speed of particles in
/// contact. This speed is the restitution times the approach speed, or zero. The impulses at the
/// end may cancel the speed that the separation of an overlap has added. The total p remains at
/// least 0, and the total p_t remains within Coulomb's cone.
///
/// Both solves process the contacts of an island one after another, in order and in reverse order,
/// until no contact changes.
class ContactProjection {
 public:
  /// Moves positions and poses from `time` [s] over `dt` [s].
  void drift(const ForceModel& force_model, Configuration& now, Real time, Real dt);
  /// Changes the velocities at the end of the step.
  void finish(const ForceModel& force_model, Configuration& now, Real time, Real dt);

 private:
  /// Moves `now` over `dt` [s] with the velocities of start_.
  void predict(const ForceModel& force_model, Configuration& now, Real dt);

  ConstraintSearch search_;
  std::vector<ContactConstraint> constraints_;
  ContactIslands islands_;
  std::vector<std::uint8_t> is_hit_;  ///< by free particle, then by rigid body
  ContactNewtonScratch newton_;
  std::vector<RigidMotion> rigid_;      ///< present motion, changed by the impulses
  std::vector<RigidMotion> predicted_;  ///< motion of the predicted poses
  Configuration start_;                 ///< start of the step; impulses change the velocities
};

}  // namespace vat
