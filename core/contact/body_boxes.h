#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/support/parallel.h"

namespace vat {

/// Boxes around the particles of bodies, and which of them are near each other. Coupled liquids
/// have none: they meet solids by SPH.
class BodyBoxes {
 public:
  /// `reach` [m]: how far from a box what is near it may be.
  void build(const Model& model, const std::vector<Vec3>& positions, Real reach,
             TaskRunner* runner);

  /// The bodies whose boxes are no further from that of `body` than the reach, in no order.
  std::span<const Index> near(Index body) const {
    return std::span(near_).subspan(near_begin_[body], near_begin_[body + 1] - near_begin_[body]);
  }

  /// Whether a particle of `body` at `p` is no further than the reach from the box of another one.
  bool is_near_another(Index body, const Vec3& p) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  void find_pairs();
  /// Of the boxes in by_left_, by the variance of their centres.
  int longest_axis() const;

  std::vector<Box> boxes_;      ///< by body
  std::vector<Box> wide_;       ///< grown by the reach
  std::vector<Index> by_left_;  ///< bodies, by the least coordinate of their boxes
  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<Index> near_begin_;
  std::vector<Index> near_;
};

}  // namespace vat
