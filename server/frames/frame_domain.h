#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/scene/scene.h"
#include "protocol/frame/frame_codec.h"

namespace vat {

/// Box that the frame grids of an epoch cover: the vat over its whole motion, and all particles of
/// the last state. It has slack, so that the grid seldom changes and particles at rest do not
/// flicker between grid positions. It is at most four times as wide as its content, so that one
/// distant drop does not make all positions coarse.
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
