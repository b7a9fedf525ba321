#pragma once

#include <cmath>

#include "core/types.h"

/// Regularised Coulomb friction of contacts that depends on the present state only (P. K. Haff, B.
/// T. Werner, Powder Technology 48 (1986) 239). Let u_t be the relative velocity of two particles
/// in contact, perpendicular to the line between their centres. The friction force is
///
///   F_t = -min(mu F_n, c_t |u_t|) u_t / |u_t|,   c_t = sqrt(k m),
///
/// with the normal force F_n, the stiffness k of the contact, and the reduced mass m of both
/// particles (at a wall, the mass of the particle). The rate c_t / m equals the angular frequency
/// sqrt(k / m) of the contact, so that friction does not reduce the stable step. The friction force
/// does not depend on the step length. Without stored displacements, sticking contacts creep with
/// the speed F_t / c_t, which is proportional to 1 / sqrt(k).
///
/// Friction acts at a friction point on the line between both particles, and depends on the slip at
/// this point. Between particles of two rigid bodies, the friction point divides the line in the
/// ratio of the radii. If one particle is free, the friction point is the centre of the free
/// particle, because a free particle has no spin. At a wall, the friction point of a rigid particle
/// is in the plane of the wall. In these cases, the two forces are equal and opposite and act at
/// the same point, which conserves angular momentum. Between two free particles, the forces act at
/// the two centres. Their torque is not balanced, so that angular momentum is not conserved.
namespace vat {

/// Returns the constant c_t [N s/m] of a contact with `stiffness` [N/m] and the reduced mass `mass`
/// [kg].
inline Real sticking_drag(Real stiffness, Real mass) {
  return std::sqrt(stiffness * mass);
}

/// The friction constants of one contact.
struct Friction {
  Real coefficient = 0;  ///< mu
  Real sticking = 0;     ///< c_t [N s/m]

  bool acts() const { return coefficient > 0; }
  /// Returns |F_t| / |u_t| <= c_t [N s/m] for the normal force `push` [N] and the slip u_t [m/s].
  Real drag(Real push, const Vec3& slip) const {
    const Real limit = coefficient * push;
    const Real speed = slip.norm();
    return sticking * speed > limit ? limit / speed : sticking;
  }
};

/// Returns the slip u_t [m/s] for the difference `velocity` of two velocities. `speed` is the
/// component of `velocity` along the unit vector `normal`.
inline Vec3 slip_velocity(const Vec3& velocity, Real speed, const Vec3& normal) {
  return velocity - speed * normal;
}

/// Vectors from the centres of two particles to their friction point [m].
struct ContactArms {
  Vec3 self = Vec3::Zero();
  Vec3 other = Vec3::Zero();
};

/// Returns the arms of two particles. `way` is the vector from the second centre to the first [m].
/// The radius of a free particle has no effect.
inline ContactArms contact_arms(const Vec3& way, bool is_rigid, Real radius, bool is_other_rigid,
                                Real other_radius) {
  if (!is_rigid && !is_other_rigid) return {};
  const Real own = is_rigid ? (is_other_rigid ? radius / (radius + other_radius) : 1) : 0;
  return {-own * way, (1 - own) * way};
}

}  // namespace vat
