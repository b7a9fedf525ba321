#pragma once

#include <algorithm>
#include <array>

#include "core/laws/vat_motion.h"
#include "core/model/model.h"

namespace vat {

/// A reflection at one wall of the vat, or at two or three walls that meet in an edge or corner.
struct Mirror {
  std::array<bool, 3> axes{};       ///< the reflected axes
  Vec3 twice_plane = Vec3::Zero();  ///< 2 w for the wall position w [m]; 0 along other axes

  /// Returns the reflection of the direction `x`.
  Vec3 turn(const Vec3& x) const {
    const auto turned = [&](std::size_t axis, Real along) { return axes[axis] ? -along : along; };
    return {turned(0, x.x()), turned(1, x.y()), turned(2, x.z())};
  }
  Vec3 place(const Vec3& x) const { return twice_plane + turn(x); }
};

/// Calls f(mirror) for each reflection whose images may be within `radius` [m] of `p`.
template <class F>
void for_each_mirror(const Model& model, const VatMotion& motion, const Vec3& p, Real radius,
                     F&& f) {
  struct Near {
    int axis;
    Real plane;
    Real distance;
  };
  std::array<Near, kWallCount> near;
  std::size_t count = 0;
  const Vat& vat = *model.scene.vat;
  for (const int wall : model.walls) {
    const Real distance = wall_distance(vat, motion, wall, p);
    if (distance >= radius) continue;
    const int axis = wall / 2;
    near[count++] = {axis, (wall % 2 == 0 ? vat.min : vat.max)[axis] + motion.offset[axis],
                     std::max(Real{0}, distance)};
  }
  const auto reflect = [&](Mirror mirror, const Near& wall) {
    mirror.axes[static_cast<std::size_t>(wall.axis)] = true;
    mirror.twice_plane[wall.axis] = 2 * wall.plane;
    return mirror;
  };
  for (std::size_t a = 0; a < count; ++a) {
    const Mirror face = reflect({}, near[a]);
    f(face);
    const Real a2 = near[a].distance * near[a].distance;
    for (std::size_t b = 0; b < a; ++b) {
      const Real b2 = a2 + near[b].distance * near[b].distance;
      if (near[b].axis == near[a].axis || b2 >= radius * radius) continue;
      const Mirror edge = reflect(face, near[b]);
      f(edge);
      for (std::size_t c = 0; c < b; ++c) {
        const Real c2 = b2 + near[c].distance * near[c].distance;
        if (edge.axes[static_cast<std::size_t>(near[c].axis)] || c2 >= radius * radius) continue;
        f(reflect(edge, near[c]));
      }
    }
  }
}

}  // namespace vat
