#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/contact/contact_search.h"
#include "core/model/model.h"

namespace vat {

/// Bodies that stay where they are, sorted so that those near others are found at little cost.
class RestingBodies {
 public:
  /// `distance` [m]: best that of the searches.
  void build(const Model& model, const std::vector<Vec3>& positions,
             const std::vector<Index>& bodies, Real distance);

  /// The bodies, in rising order, whose boxes are no further than `distance` from that of `points`.
  void find_candidates(std::span<const Vec3> points, Real distance,
                       std::vector<Index>& candidates) const;
  /// Drops those without a particle closer than `distance` to one of `points`.
  void keep_near(std::span<const Vec3> points, Real distance, std::vector<Index>& candidates) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  /// Everything along axes that repeat.
  Box box_of(std::span<const Vec3> points) const;
  const Box& box(Index body) const { return boxes_[place_[body]]; }

  PeriodicBox periodic_;
  std::vector<Index> bodies_;  ///< by the least x of their boxes, as the next two
  std::vector<Box> boxes_;
  std::vector<Real> furthest_;  ///< greatest x of this box and those before
  std::vector<Index> place_;    ///< by body, among those
  SortedParticles particles_;
};

}  // namespace vat
