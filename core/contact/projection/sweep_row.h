#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/types.h"

namespace vat {

/// A contact of ContactSolve::sweep(): its impulse, and its terms at the geometry of the solve. The
/// impulse of a contact changes the velocities of its ends at once.
struct SweepRow {
  /// The quantity that the normal impulse keeps at or above zero.
  enum class Excess : std::uint8_t {
    separation_speed,  ///< above `required` [m/s]
    gap,               ///< between the ends at the end of the step, above `required` [m]
    wall_gap,          ///< between an end and a wall at the end of the step, above `required` [m]
  };
  struct Side {
    Vec3* velocity = nullptr;  ///< of the particle or of the centre of mass; null: a wall [m/s]
    Vec3* spin = nullptr;      ///< null: the end does not turn [rad/s]
    const Mat3* inverse_inertia = nullptr;
    Real inverse_mass = 0;         ///< 0: impulses do not move the end [1/kg]
    Vec3 arm = Vec3::Zero();       ///< of the contact point [m]
    Vec3 late_arm = Vec3::Zero();  ///< of the particle at the end of the step [m]

    Vec3 velocity_at(const Vec3& point) const {
      if (spin == nullptr) return *velocity;
      return *velocity + spin->cross(point);
    }
    void apply(const Vec3& impulse) const {
      if (inverse_mass == 0) return;
      *velocity += inverse_mass * impulse;
      if (spin != nullptr) *spin += *inverse_inertia * arm.cross(impulse);
    }
  };

  std::array<Side, 2> sides;  ///< the second one may be a wall
  Vec3 normal;
  Vec3 wall_velocity = Vec3::Zero();  ///< [m/s]
  Mat3 mobility;                      ///< change of slip per impulse [1/kg]
  Vec3 normal_mobility;               ///< mobility * normal
  Real inverse_mobility;              ///< inverse of the mobility along the normal [kg]
  Real scale;                         ///< displacement in thresholds per normal impulse [1/(N s)]
  Real friction;
  Excess kind = Excess::separation_speed;
  Real required = 0;
  Real dt;                        ///< [s]
  Vec3 start = Vec3::Zero();      ///< relative position without velocities; for gaps [m]
  Real push;                      ///< impulse along the normal [N s]
  Vec3 friction_impulse;          ///< impulse perpendicular to the normal [N s]
  Vec3 gradient;                  ///< change of the impulse by the last sweeps [N s]
  Vec3 direction = Vec3::Zero();  ///< of the conjugate gradient method [N s]

  Vec3 impulse() const { return push * normal + friction_impulse; }

  /// Returns the relative velocity of the ends at the contact point [m/s].
  Vec3 slip() const {
    const Vec3 own = sides[0].velocity_at(sides[0].arm) - wall_velocity;
    if (sides[1].velocity == nullptr) return own;
    return own - sides[1].velocity_at(sides[1].arm);
  }

  /// Returns the excess as a speed, at the relative velocity `slip` of the contact point [m/s].
  Real excess(const Vec3& slip) const {
    if (kind == Excess::separation_speed) return slip.dot(normal) - required;
    Vec3 late = sides[0].velocity_at(sides[0].late_arm);
    if (kind == Excess::wall_gap) return late.dot(normal) + (start.dot(normal) - required) / dt;
    late -= sides[1].velocity_at(sides[1].late_arm);
    return ((start + dt * late).norm() - required) / dt;
  }

  /// Adds an impulse to both ends, without a change of the stored impulse.
  void apply(const Vec3& impulse) const {
    sides[0].apply(impulse);
    sides[1].apply(-impulse);
  }

  /// Changes the impulse so that the excess is 0 or the ends separate, and so that the contact
  /// sticks or has the greatest friction. Returns the greater displacement of the ends in `dt` by
  /// both changes, in thresholds.
  Real relax() {
    Vec3 velocity = slip();
    const Real change = std::max(Real{0}, push - excess(velocity) * inverse_mobility) - push;
    push += change;
    velocity += change * normal_mobility;
    Vec3 whole = change * normal;
    Real greatest = std::abs(change);
    const Real limit = friction * push;
    if (limit != 0 || !friction_impulse.isZero(0)) {
      const Vec3 across = velocity - velocity.dot(normal) * normal;
      const Real resistance = across.dot(mobility * across);
      Vec3 wanted = friction_impulse;
      if (resistance > 0) wanted -= across.squaredNorm() / resistance * across;
      const Real size = wanted.norm();
      if (size > limit) wanted *= limit / size;
      const Vec3 rubbing = wanted - friction_impulse;
      friction_impulse = wanted;
      whole += rubbing;
      greatest = std::max(greatest, rubbing.norm());
    }
    if (greatest > 0) apply(whole);
    return scale * greatest;
  }
};

}  // namespace vat
