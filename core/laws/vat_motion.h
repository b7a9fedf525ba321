#pragma once

#include "core/scene/world.h"
#include "core/types.h"

namespace vat {

/// Displacement, velocity and acceleration of a moving vat or a driven body.
struct VatMotion {
  Vec3 offset = Vec3::Zero();        ///< displacement from the position at time 0 [m]
  Vec3 velocity = Vec3::Zero();      ///< [m/s]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]
};
VatMotion vat_motion(const Vat& vat, Real time);
/// Returns the motion of a vat or of a driven body by `slide`.
VatMotion slide_motion(const SlideMotion& slide, Real time);
/// Returns the part of the vat's motion that users cause. `time` must not be before `hand.start`.
VatMotion hand_motion(const HandMotion& hand, Real time);
/// Returns whether the motion caused by users continues at `time`.
bool is_moving(const HandMotion& hand, Real time);

/// Returns whether a wall of the vat moves at or after `time`, in its normal or a tangential
/// direction.
bool moves_walls(const Vat& vat, Real time);
/// Returns an upper bound of the normal speeds of the walls at and after `time` [m/s].
Real greatest_vat_speed(const Vat& vat, Real time);

/// wall_normal() returns the inward normal of a wall. wall_distance() returns the signed distance
/// of `p` from a wall [m], negative outside the vat. wall_count() returns the number of walls of
/// `vat`. The last of the kWallCount walls is the lid.
inline constexpr int kWallCount = 6;
inline Vec3 wall_normal(int wall) {
  return wall % 2 == 0 ? Vec3(Vec3::Unit(wall / 2)) : Vec3(-Vec3::Unit(wall / 2));
}
inline Real wall_distance(const Vat& vat, const VatMotion& motion, int wall, const Vec3& p) {
  const int axis = wall / 2;
  const Real x = p[axis] - motion.offset[axis];
  return wall % 2 == 0 ? x - vat.min[axis] : vat.max[axis] - x;
}
inline int wall_count(const Vat& vat) {
  return vat.lid ? kWallCount : kWallCount - 1;
}

}  // namespace vat
