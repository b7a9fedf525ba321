#pragma once

#include <cmath>

#include "core/types.h"

/// Coulomb friction of contacts, regularised and without memory (P. K. Haff, B. T. Werner, Powder
/// Technology 48 (1986) 239): two touching ends whose velocities differ by the slip u_t, across the
/// line between them, drag on each other with
///
///   F_t = -min(mu F_n, c_t |u_t|) u_t / |u_t|,   c_t = sqrt(k m),
///
/// F_n the push of their contact, k its stiffness, m the reduced mass of the two particles (against
/// a wall, the particle's). c_t / m is the frequency sqrt(k / m) at which the contact itself would
/// oscillate, so that friction adds no process faster than what a step must resolve anyway, and is
/// the same at any step. It is a force of the state alone: contacts that stick creep at
/// F_t / c_t, which falls as 1 / sqrt(k).
///
/// Both ends feel it at one point of the line between them, with the slip of that point. That of
/// two rigid bodies divides the line as their particles' radii do; a free particle, which has no
/// spin, is touched at its centre, and a wall at its plane. So the forces are equal and opposite
/// and have no couple, which keeps angular momentum too; but between two free particles both are at
/// their centres, and the couple, the force times the distance, is lost.
namespace vat {

/// c_t [N s/m] of a contact of `stiffness` [N/m] with the reduced mass `mass` [kg].
inline Real sticking_drag(Real stiffness, Real mass) {
  return std::sqrt(stiffness * mass);
}

/// The two constants of one contact.
struct Friction {
  Real coefficient = 0;  ///< mu
  Real sticking = 0;     ///< c_t [N s/m]

  bool acts() const { return coefficient > 0; }
  /// |F_t| / |u_t| [N s/m], at most c_t, under a push of F_n [N] at the slip u_t [m/s].
  Real drag(Real push, const Vec3& slip) const {
    const Real limit = coefficient * push;
    const Real speed = slip.norm();
    return sticking * speed > limit ? limit / speed : sticking;
  }
};

/// u_t, of the difference of two velocities and its part `speed` along the unit vector `normal`.
inline Vec3 slip_velocity(const Vec3& velocity, Real speed, const Vec3& normal) {
  return velocity - speed * normal;
}

/// From the centres of two particles to the point where they rub [m].
struct ContactArms {
  Vec3 self = Vec3::Zero();
  Vec3 other = Vec3::Zero();
};

/// `way`: from the second centre to the first [m]. A particle that is not rigid has no radius here.
inline ContactArms contact_arms(const Vec3& way, bool is_rigid, Real radius, bool is_other_rigid,
                                Real other_radius) {
  if (!is_rigid && !is_other_rigid) return {};
  const Real own = is_rigid ? (is_other_rigid ? radius / (radius + other_radius) : 1) : 0;
  return {-own * way, (1 - own) * way};
}

}  // namespace vat
