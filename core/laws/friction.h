#pragma once

#include <cmath>

#include "core/types.h"

/// Regularised Coulomb friction of contacts, without memory (P. K. Haff, B. T. Werner, Powder
/// Technology 48 (1986) 239). Let u_t be the relative velocity of two particles in contact,
/// perpendicular to the line between their centres. The friction force is
///
///   F_t = -min(mu F_n, c_t |u_t|) u_t / |u_t|,   c_t = sqrt(k m),
///
/// with the normal force F_n, the stiffness k of the contact, and the reduced mass m of both
/// particles (at a wall, the mass of the particle). c_t / m equals the contact frequency sqrt(k /
/// m). Friction therefore does not reduce the stable step, and does not depend on the step.
/// Friction depends on the present state only. Sticking contacts therefore creep with the speed F_t
/// / c_t, which is proportional to 1 / sqrt(k).
///
/// Friction acts on both particles at one point of the line between them, and uses the slip at this
/// point. Between two rigid bodies, the point divides the line in the ratio of the radii. The point
/// of a free particle, which has no spin, is its centre, and that of a wall is in its plane. The
/// forces are therefore equal, opposite and without a couple, and conserve angular momentum.
/// Between two free particles, the forces act at the two centres. Their torque is not balanced, so
/// angular momentum is not conserved.
namespace vat {

/// The constant c_t [N s/m] of a contact with this stiffness [N/m] and reduced mass [kg].
inline Real sticking_drag(Real stiffness, Real mass) {
  return std::sqrt(stiffness * mass);
}

/// The constants of the friction of one contact.
struct Friction {
  Real coefficient = 0;  ///< mu
  Real sticking = 0;     ///< c_t [N s/m]

  bool acts() const { return coefficient > 0; }
  /// |F_t| / |u_t| [N s/m], at most c_t, for the normal force F_n [N] and the slip u_t [m/s].
  Real drag(Real push, const Vec3& slip) const {
    const Real limit = coefficient * push;
    const Real speed = slip.norm();
    return sticking * speed > limit ? limit / speed : sticking;
  }
};

/// The slip u_t, from the difference of two velocities and its component `speed` along the unit
/// vector `normal`.
inline Vec3 slip_velocity(const Vec3& velocity, Real speed, const Vec3& normal) {
  return velocity - speed * normal;
}

/// Vectors from the centres of two particles to the point of their friction [m].
struct ContactArms {
  Vec3 self = Vec3::Zero();
  Vec3 other = Vec3::Zero();
};

/// The arms of two particles. `way` points from the second centre to the first [m]. The radius of a
/// particle that is not rigid has no effect.
inline ContactArms contact_arms(const Vec3& way, bool is_rigid, Real radius, bool is_other_rigid,
                                Real other_radius) {
  if (!is_rigid && !is_other_rigid) return {};
  const Real own = is_rigid ? (is_other_rigid ? radius / (radius + other_radius) : 1) : 0;
  return {-own * way, (1 - own) * way};
}

}  // namespace vat
