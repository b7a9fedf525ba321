#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "core/scene/world.h"
#include "core/types.h"

namespace vat {

/// The images of points in a world that is periodic along some axes. The length along a periodic
/// axis must be at least twice the radius of each search.
class PeriodicBox {
 public:
  /// Constructs the box of a world without periodic axes.
  PeriodicBox() = default;
  explicit PeriodicBox(const Periodicity& periodicity) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      if (!periodicity.axes[axis]) continue;
      repeats_[axis] = any_ = true;
      min_[a] = periodicity.min[a];
      max_[a] = periodicity.max[a];
      length_[a] = max_[a] - min_[a];
      half_[a] = length_[a] / 2;
    }
  }

  bool any() const { return any_; }
  bool repeats(int axis) const { return repeats_[static_cast<std::size_t>(axis)]; }
  /// Returns the length along a periodic axis [m].
  Real length(int axis) const { return length_[axis]; }

  /// Returns the image of `p` in the box: min <= x < max along each periodic axis. A point in the
  /// box is returned with the same bits.
  Vec3 wrap(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!repeats(axis) || (p[axis] >= min_[axis] && p[axis] < max_[axis])) continue;
      p[axis] -= length_[axis] * std::floor((p[axis] - min_[axis]) / length_[axis]);
      // Rounding may move the image out of the box.
      if (p[axis] < min_[axis] || p[axis] >= max_[axis]) p[axis] = min_[axis];
    }
    return p;
  }

  /// Returns the shortest image of the difference `x` of two points in the box. nearest(-x) is
  /// exactly -nearest(x).
  Vec3 nearest(const Vec3& x) const {
    return {nearest(x.x(), 0), nearest(x.y(), 1), nearest(x.z(), 2)};
  }
  /// Returns the shortest image of the component `x` along `axis`.
  Real nearest(Real x, int axis) const {
    if (x > half_[axis]) return x - length_[axis];
    if (x < -half_[axis]) return x + length_[axis];
    return x;
  }

  /// Calls f(shift) for each image p + shift of a point of the box that is within `radius` of the
  /// box. The zero shift is included.
  template <class F>
  void for_each_image(const Vec3& p, Real radius, F&& f) const {
    const Real reach = radius * (1 + 1e-6);  // more than the rounding error of a difference
    std::array<int, 3> first{};
    std::array<int, 3> last{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!repeats_[a]) continue;
      if (p[axis] + reach >= max_[axis]) first[a] = -1;
      if (p[axis] - reach <= min_[axis]) last[a] = 1;
    }
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int x = first[0]; x <= last[0]; ++x) {
          f(Vec3(x * length_.x(), y * length_.y(), z * length_.z()));
        }
      }
    }
  }

 private:
  bool any_ = false;
  std::array<bool, 3> repeats_{};
  Vec3 min_ = Vec3::Zero();
  Vec3 max_ = Vec3::Zero();
  Vec3 length_ = Vec3::Zero();
  Vec3 half_ = Vec3::Constant(std::numeric_limits<Real>::infinity());
};

}  // namespace vat
