#pragma once

#include <array>
#include <span>

#include "core/support/check.h"
#include "core/types.h"

namespace vat {

/// The following functions compute the volume of a cell and its derivatives. The corners of a cell
/// are numbered as in SampledCell. Faces are bilinear: the volume is the mean over both divisions
/// of the faces into triangles. All terms are differences of positions, so that rounding errors do
/// not increase with the distance from the origin.

namespace cell {

/// For the face that contains the corner `c` and is perpendicular to `axis`: returns its other
/// three corners, in their order along the boundary. The order has the same orientation for all
/// faces, seen from outside.
inline std::array<Index, 3> face_of(Index c, Index axis) {
  const Index i = Index{1} << (axis + 1) % 3;
  const Index j = Index{1} << (axis + 2) % 3;
  const bool is_odd = ((c ^ c >> 1 ^ c >> 2) & 1) != 0;
  return is_odd ? std::array{c ^ i, c ^ i ^ j, c ^ j} : std::array{c ^ j, c ^ i ^ j, c ^ i};
}

inline Vec3 quarter_turn(const Vec3& v) {
  return {v.z(), 0, -v.x()};
}

}  // namespace cell

/// Returns the derivative of the volume with respect to the position of the corner `c` [m^2]; in
/// two dimensions, the derivative of the area [m].
inline Vec3 cell_slope(std::span<const Vec3> at, const std::array<Index, 8>& corners, Index c,
                       int dimensions) {
  VAT_ASSERT(c < (dimensions == 2 ? 4U : 8U));
  if (dimensions == 2) {
    const bool is_outer = c == 0 || c == 3;
    const Vec3 across =
        is_outer ? Vec3(at[corners[2]] - at[corners[1]]) : Vec3(at[corners[0]] - at[corners[3]]);
    return cell::quarter_turn(across) * (c == 3 || c == 2 ? 0.5 : -0.5);
  }
  const Vec3& own = at[corners[c]];
  Vec3 sum = Vec3::Zero();
  for (Index axis = 0; axis < 3; ++axis) {
    const std::array<Index, 3> face = cell::face_of(c, axis);
    const Vec3 a = at[corners[face[0]]] - own;
    const Vec3 b = at[corners[face[1]]] - own;
    const Vec3 d = at[corners[face[2]]] - own;
    sum += a.cross(b) + b.cross(d) + a.cross(d);
  }
  return sum / 12;
}

/// Returns the volume [m^3], or in two dimensions the area [m^2]. The result is negative for an
/// inverted cell.
inline Real cell_volume(std::span<const Vec3> at, const std::array<Index, 8>& corners,
                        int dimensions) {
  const Vec3& origin = at[corners[0]];
  if (dimensions == 2) {
    const Vec3 across = at[corners[2]] - at[corners[1]];
    return (at[corners[3]] - origin).dot(cell::quarter_turn(across)) / 2;
  }
  Real sum = 0;
  for (Index axis = 0; axis < 3; ++axis) {
    for (const Index c : {Index{0}, Index{7}}) {
      const std::array<Index, 3> face = cell::face_of(c, axis);
      const Vec3 p = at[corners[c]] - origin;
      const Vec3 a = at[corners[face[0]]] - origin;
      const Vec3 b = at[corners[face[1]]] - origin;
      const Vec3 d = at[corners[face[2]]] - origin;
      sum += p.dot(a.cross(b) + b.cross(d) + a.cross(d)) + a.dot(b.cross(d));
    }
  }
  return sum / 12;
}

}  // namespace vat
