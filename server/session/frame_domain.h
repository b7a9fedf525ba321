#pragma once

#include <optional>

#include "core/scene/scene.h"
#include "protocol/frame_codec.h"

namespace vat {

/// The box that the frame grids of one epoch cover: the vat over its whole motion, and all
/// particles that have been sent. It only grows, with slack, so that the grid seldom changes and a
/// particle at rest does not flicker between grid positions.
class FrameDomain {
 public:
  FrameDomain() = default;
  explicit FrameDomain(const std::optional<Vat>& vat);
  void include(const PublishedState& state);
  FrameGrid grid(double max_error) const;

 private:
  void include(const Vec3& min, const Vec3& max);

  bool empty_ = true;
  Vec3 min_ = Vec3::Zero();
  Vec3 max_ = Vec3::Zero();
};

}  // namespace vat
