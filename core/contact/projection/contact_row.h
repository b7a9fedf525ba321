#pragma once

#include <array>

#include "core/types.h"

namespace vat {

/// A contact in ContactNewton. Its impulse as a function of the slip is the derivative of a convex
/// energy. There are two laws, which both become Coulomb's law when the iterations have converged:
/// - with a lift, the impulse is in Coulomb's cone. At the minimum of the energy, a sliding contact
///   would separate with the speed friction * |slip|. The lift requires this speed in addition
///   (V. Acary, F. Cadoux, C. Lemarechal, J. Malick, ZAMM 91 (2011) 155).
/// - with a limit, the friction impulse is at most the limit, for any normal impulse.
struct ContactRow {
  static constexpr Index kNoBlock = ~Index{0};
  struct Side {
    Index block = kNoBlock;  ///< of the velocity; the next block is that of the spin
    bool turns = false;
    Vec3 arm = Vec3::Zero();
  };

  Index contact;
  std::array<Side, 2> sides;
  Vec3 normal;
  Vec3 slip;    ///< above the required one, before the changes of velocities [m/s]
  Real mass;    ///< inverse of the mobility [kg]
  Real weight;  ///< of the multiplier [kg]
  Real friction;
  Real lift;        ///< additional separation speed [m/s]
  bool has_limit;   ///< whether the law is the one with a limit
  Real limit;       ///< of friction [N s]
  Real scale;       ///< displacement in thresholds per unit of speed [s/m]
  Vec3 multiplier;  ///< [N s]
  Vec3 at;          ///< slip at the present changes [m/s]
  Vec3 turn;        ///< its change by a Newton step
  Vec3 impulse;     ///< at the present changes [N s]
};

/// Returns the impulse of a contact at a slip: multiplier - weight * slip, projected on the
/// impulses that the law permits.
Vec3 impulse_at(const ContactRow& row, const Vec3& slip);

/// Returns -d impulse / d slip [kg], which is symmetric and positive semidefinite.
Mat3 slope_at(const ContactRow& row, const Vec3& slip);

/// Sets multiplier, lift and limit to those of the present slip. Returns the speed by which the
/// slip violates the constraint [m/s].
Real update(ContactRow& row);

}  // namespace vat
