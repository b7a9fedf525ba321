#pragma once

#include "core/scene/scene.h"
#include "core/types.h"

namespace vat {

/// Where a moving vat is: a function of time alone.
struct VatMotion {
  Vec3 offset = Vec3::Zero();        ///< from its place at time 0 [m]
  Vec3 velocity = Vec3::Zero();      ///< [m/s]
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]
};
VatMotion vat_motion(const Vat& vat, Real time);
/// What of it is the hand's, from its start on.
VatMotion hand_motion(const HandMotion& hand, Real time);
/// Whether it is not at rest at its target yet.
bool is_moving(const HandMotion& hand, Real time);

/// Whether any of its walls ever moves, across itself or along; of a hand's motions those that are
/// not over at `time`.
bool moves_walls(const Vat& vat, Real time);
/// From `time` on no wall moves across itself any faster [m/s].
Real greatest_vat_speed(const Vat& vat, Real time);

/// How far `p` is inside each wall of the vat (negative: beyond it) [m], and the walls' inward
/// normals. The last wall is the lid.
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
