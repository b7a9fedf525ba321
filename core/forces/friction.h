#pragma once

#include <Eigen/Geometry>
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
/// Both ends feel it at their particles' centres, as they do the push, and slip is that of the
/// centres. So forces are equal and opposite to the bit, and a rigid body of one particle does not
/// roll; the angular momentum of two bodies that rub changes, by the forces' couple, F_t times the
/// distance of the centres.
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

/// Calls f(t) for two unit vectors across `normal` and each other; for -normal they are the same
/// but for their signs.
template <class F>
void for_each_across(const Vec3& normal, F&& f) {
  const Vec3 first = normal.unitOrthogonal();
  f(first);
  f(Vec3(normal.cross(first)));
}

}  // namespace vat
