#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/scratch.h"
#include "core/evaluation/force_model.h"
#include "core/laws/vat_motion.h"

namespace vat {

/// What moves with one end of a contact. A free particle is touched at its centre and a rigid body
/// at its surface, so that the angular momentum of any two is kept.
struct ContactEnd {
  Index particle = kNoParticle;  ///< kNoParticle: a wall
  Index rigid = kNoParticle;     ///< the body's place among the rigid ones; kNoParticle: a free one
  Real inverse_mass = 0;         ///< of the particle or the body; 0: nothing moves it [1/kg]
  Vec3 arm = Vec3::Zero();       ///< from the body's centre of mass to the point of contact [m]
};

/// A contact by projection, of two particles or of one and a wall: their distance is not to be
/// below the threshold.
struct ContactConstraint {
  std::array<ContactEnd, 2> ends{};
  int wall = -1;
  Real threshold = 0;  ///< [m]
  Real friction = 0;
  Real restitution = 0;

  Vec3 normal = Vec3::Zero();  ///< of impulses, towards the first end
  Real mobility = 0;           ///< speed of parting by a unit impulse along the normal [1/kg]
  Real approach = 0;           ///< speed of parting before the step's impulses [m/s]
  Real parting = 0;            ///< speed at which they are to part at the step's end [m/s]
  Real push = 0;               ///< impulse along the normal [N s]
  Vec3 friction_impulse = Vec3::Zero();  ///< impulse across the normal [N s]
  ContactImpulse last{};                 ///< of the step before
  Vec3 drift = Vec3::Zero();             ///< impulse at the start of this one [N s]
  // Of the conjugate gradients [N s].
  Vec3 gradient = Vec3::Zero();
  Vec3 direction = Vec3::Zero();

  Vec3 impulse() const { return push * normal + friction_impulse; }  ///< on the first end [N s]
  std::uint64_t other() const {
    return wall >= 0 ? static_cast<std::uint64_t>(wall)
                     : std::uint64_t{kWallCount} + ends[1].particle;
  }
};

/// A rigid body as contacts see it.
struct RigidMotion {
  Vec3 velocity;         ///< [m/s] of the centre of mass
  Vec3 spin;             ///< [rad/s]
  Mat3 inverse_inertia;  ///< in world axes; zero for a held body, as is its inverse mass
  Real inverse_mass;     ///< [1/kg]
};

/// A body's motion, of the orientation and momenta of `state`.
RigidMotion rigid_motion(const RigidModel& rigid, const RigidState& state, bool is_held);

/// The contacts that the configuration has or nearly has, in an order that depends on it alone:
/// those of projections, of which something moves one end. Needs the list of contacts; walls are as
/// `vat`. False, and none, where there are more than kMaxProjections.
class ConstraintSearch {
 public:
  bool find(const ForceModel& force_model, const Configuration& at, const VatMotion& vat,
            std::vector<ContactConstraint>& constraints);

 private:
  std::vector<std::vector<ContactConstraint>> blocks_;  ///< by block of particles
};

/// Gives contacts what they did in the step before; both are by particle and other.
void recall(const std::vector<ContactImpulse>& last, std::vector<ContactConstraint>& constraints);
/// What they did in this one, of `dt` [s].
void record(const std::vector<ContactConstraint>& constraints, Real dt,
            std::vector<ContactImpulse>& contacts);

/// How far beyond its threshold a contact is taken in, in thresholds: impulses may close the gap.
inline constexpr Real kContactMargin = 0.1;

}  // namespace vat
