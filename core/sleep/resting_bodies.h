#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/contact/contact_search.h"
#include "core/model/model.h"

namespace vat {

/// Spatial index of resting bodies, for fast search of bodies near given points.
class RestingBodies {
 public:
  /// Builds the index. `distance` [m] should be the distance of later searches.
  void build(const Model& model, const std::vector<Vec3>& positions,
             const std::vector<Index>& bodies, Real distance);

  /// Finds the bodies whose boxes are within `distance` of the box of `points`, in ascending order.
  void find_candidates(std::span<const Vec3> points, Real distance,
                       std::vector<Index>& candidates) const;
  /// Removes candidates with no particle closer than `distance` to one of `points`.
  void keep_near(std::span<const Vec3> points, Real distance, std::vector<Index>& candidates) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  /// Returns the bounding box of the points, unbounded along periodic axes.
  Box box_of(std::span<const Vec3> points) const;
  const Box& box(Index body) const { return boxes_[place_[body]]; }

  PeriodicBox periodic_;
  std::vector<Index> bodies_;  ///< sorted by the lower x of their boxes
  std::vector<Box> boxes_;
  /// Maximum upper x of this box and the preceding boxes.
  std::vector<Real> furthest_;
  std::vector<Index> place_;  ///< index in the lists above, by body
  SortedParticles particles_;
};

}  // namespace vat
