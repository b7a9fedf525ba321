#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/scratch.h"
#include "core/evaluation/force_model.h"
#include "core/laws/vat_motion.h"

namespace vat {

/// One end of a contact: a free particle, a rigid body or a wall. The contact point of a free
/// particle is its centre. The contact point of a rigid body is at its surface, so that angular
/// momentum is conserved.
struct ContactEnd {
  Index particle = kNoParticle;  ///< kNoParticle: a wall
  Index rigid = kNoParticle;     ///< index of the rigid body; kNoParticle: no rigid body
  Real inverse_mass = 0;         ///< of the particle or body; 0: the end does not move [1/kg]
  Vec3 arm = Vec3::Zero();       ///< from the body's centre of mass to the contact point [m]
};

/// A contact by projection between two particles, or between a particle and a wall. The constraint
/// is that their distance is at least the threshold.
struct ContactConstraint {
  std::array<ContactEnd, 2> ends{};
  int wall = -1;
  Real threshold = 0;  ///< [m]
  Real friction = 0;
  Real restitution = 0;

  Real distance = 0;           ///< at the start of the step [m]
  Vec3 normal = Vec3::Zero();  ///< direction of impulses on the first end
  Real mobility = 0;           ///< separation speed per unit impulse along the normal [1/kg]
  Real approach = 0;           ///< separation speed before the impulses of the step [m/s]
  Real parting = 0;            ///< required separation speed at the end of the step [m/s]
  Real push = 0;               ///< impulse along the normal [N s]
  Vec3 friction_impulse = Vec3::Zero();  ///< impulse perpendicular to the normal [N s]
  ContactImpulse last{};                 ///< forces of the last step; zero if the contact is new
  bool is_new = true;                    ///< the last step had no such contact
  Vec3 drift = Vec3::Zero();             ///< impulse at the start of the step [N s]

  Vec3 impulse() const { return push * normal + friction_impulse; }  ///< on the first end [N s]
  std::uint64_t other() const {
    return wall >= 0 ? static_cast<std::uint64_t>(wall)
                     : std::uint64_t{kWallCount} + ends[1].particle;
  }
};

/// The motion and inertia of a rigid body for contacts.
struct RigidMotion {
  Vec3 velocity;         ///< velocity of the centre of mass [m/s]
  Vec3 spin;             ///< [rad/s]
  Mat3 inverse_inertia;  ///< in world axes; zero for a held body, like inverse_mass
  Real inverse_mass;     ///< [1/kg]
};

/// Returns the motion and inertia of a rigid body in `state`. `is_held`: whether the body is fixed.
RigidMotion rigid_motion(const RigidModel& rigid, const RigidState& state, bool is_held);

/// A search for the contacts by projection with at least one end that moves. find() includes
/// contacts with a gap of up to kContactMargin. The order of the contacts depends on the
/// configuration only. find() requires the contact list of the workspace; `vat` is the motion of
/// the walls. If there are more than kMaxProjections contacts, find() returns false, without
/// contacts.
class ConstraintSearch {
 public:
  bool find(const ForceModel& force_model, const Configuration& at, const VatMotion& vat,
            std::vector<ContactConstraint>& constraints);

 private:
  std::vector<std::vector<ContactConstraint>> blocks_;  ///< by block of particles
};

/// Sets ContactConstraint::last from the forces of the last step. Both lists must be ordered by
/// particle and other.
void recall(const std::vector<ContactImpulse>& last, std::vector<ContactConstraint>& constraints);
/// Stores the forces of the present step, which are the impulses divided by the step length `dt`
/// [s]. The contacts of a body or particle are steady if none of its contacts had an impact, which
/// is an approach faster than `slow` [m/s]. Otherwise a contact is steady if its forces are at most
/// twice those of the last step. `is_hit` is scratch.
void record(const Model& model, const std::vector<ContactConstraint>& constraints, Real dt,
            Real slow, std::vector<std::uint8_t>& is_hit, std::vector<ContactImpulse>& contacts);

/// The gap up to which ConstraintSearch includes contacts, in thresholds. Impulses may close such a
/// gap.
inline constexpr Real kContactMargin = 0.1;

}  // namespace vat
