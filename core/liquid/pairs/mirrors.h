#pragma once

#include <array>
#include <span>

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

/// Calls f(walls) for each set of one to three walls, if the images of `p` in these walls may be
/// within `radius` [m] of `p`. No two walls of a set have parallel normals. The function f receives
/// a span of wall numbers.
template <class F>
void for_each_wall_set(const Model& model, const VatMotion& motion, const Vec3& p, Real radius,
                       F&& f) {
  std::array<int, kWallCount> near;
  std::array<Real, kWallCount> square;  // squared distance
  std::size_t count = 0;
  for (const int wall : model.walls) {
    const Real distance = wall_distance(*model.scene.vat, motion, wall, p);
    if (distance >= radius) continue;
    near[count] = wall;
    square[count++] = distance > 0 ? distance * distance : 0;
  }
  const Real reach2 = radius * radius;
  const auto call = [&](auto... walls) { f(std::span<const int>(std::array{walls...})); };
  for (std::size_t a = 0; a < count; ++a) {
    call(near[a]);
    for (std::size_t b = 0; b < a; ++b) {
      const Real of_edge = square[a] + square[b];
      if (near[b] / 2 == near[a] / 2 || of_edge >= reach2) continue;
      call(near[a], near[b]);
      for (std::size_t c = 0; c < b; ++c) {
        const bool is_new = near[c] / 2 != near[a] / 2 && near[c] / 2 != near[b] / 2;
        if (is_new && of_edge + square[c] < reach2) call(near[a], near[b], near[c]);
      }
    }
  }
}

/// Calls f(mirror) for each reflection whose images may be within `radius` [m] of `p`.
template <class F>
void for_each_mirror(const Model& model, const VatMotion& motion, const Vec3& p, Real radius,
                     F&& f) {
  const Vat& vat = *model.scene.vat;
  for_each_wall_set(model, motion, p, radius, [&](std::span<const int> walls) {
    Mirror mirror;
    for (const int wall : walls) {
      const int axis = wall / 2;
      mirror.axes[static_cast<std::size_t>(axis)] = true;
      mirror.twice_plane[axis] =
          2 * ((wall % 2 == 0 ? vat.min : vat.max)[axis] + motion.offset[axis]);
    }
    f(mirror);
  });
}

}  // namespace vat
