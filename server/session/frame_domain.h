#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/scene/scene.h"
#include "protocol/frame/frame_codec.h"

namespace vat {

/// The box that the frame grids of one epoch cover: the vat over its whole motion, and all
/// particles of the last state. It has slack, so that the grid seldom changes and a particle at
/// rest does not flicker between grid positions; but it is at most four times as wide as what it
/// has to cover, so that neither a drop that once flew far nor a long fall makes all others coarse.
class FrameDomain {
 public:
  FrameDomain() = default;
  explicit FrameDomain(const std::optional<Vat>& vat);
  void include(const PublishedState& state);
  FrameGrid grid(double max_error) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  Box vat_;
  Box box_;
};

}  // namespace vat
