#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/support/parallel.h"

namespace vat {

/// Boxes around the particles of bodies, and the pairs of bodies whose boxes are near each other.
/// Coupled liquids have none, because they interact with solids by SPH.
class BodyBoxes {
 public:
  /// `reach` [m]: the distance of near boxes.
  void build(const Model& model, const std::vector<Vec3>& positions, Real reach,
             TaskRunner* runner);

  /// The bodies whose boxes are within the reach of that of `body`, unordered.
  std::span<const Index> near(Index body) const {
    return std::span(near_).subspan(near_begin_[body], near_begin_[body + 1] - near_begin_[body]);
  }

  /// Returns whether a particle of `body` at `p` is within the reach of the box of another body.
  bool is_near_another(Index body, const Vec3& p) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  void find_pairs();
  /// The axis with the largest variance of the centres of the boxes in by_left_.
  int longest_axis() const;

  std::vector<Box> boxes_;      ///< by body
  std::vector<Box> wide_;       ///< boxes_ extended by the reach
  std::vector<Index> by_left_;  ///< bodies, by the lower end of their boxes
  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<Index> near_begin_;
  std::vector<Index> near_;
};

}  // namespace vat
