#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/support/parallel.h"

namespace vat {

/// Bounding boxes of the particle centres of bodies, and the pairs of bodies with near boxes.
/// Coupled liquids, which interact with solids by SPH, have no boxes.
class BodyBoxes {
 public:
  /// Finds the boxes and the pairs of boxes within the distance `reach` [m].
  void build(const Model& model, const std::vector<Vec3>& positions, Real reach,
             TaskRunner* runner);

  /// Returns the bodies whose boxes are near the box of `body`, in no particular order.
  std::span<const Index> near(Index body) const {
    return std::span(near_).subspan(near_begin_[body], near_begin_[body + 1] - near_begin_[body]);
  }

  /// Returns whether a particle of `body` at `p` is within the distance `reach` of the box of
  /// another body.
  bool is_near_another(Index body, const Vec3& p) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  void find_pairs();
  /// Returns the axis along which the box centres of the bodies in by_left_ have the largest
  /// variance.
  int longest_axis() const;

  std::vector<Box> boxes_;      ///< by body
  std::vector<Box> wide_;       ///< boxes_ extended by `reach`
  std::vector<Index> by_left_;  ///< bodies, sorted by the lower end of their boxes
  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<Index> near_begin_;
  std::vector<Index> near_;
};

}  // namespace vat
