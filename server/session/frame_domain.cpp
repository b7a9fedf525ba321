#include "server/session/frame_domain.h"

#include <algorithm>
#include <limits>

namespace vat {

FrameDomain::FrameDomain(const std::optional<Vat>& vat) {
  if (!vat) return;
  include(vat->min, vat->max);
  if (!vat->motion) return;
  const Vec3 reach = vat->motion->axis.normalized() * vat->motion->stroke;
  include(vat->min + reach, vat->max + reach);
}

void FrameDomain::include(const PublishedState& state) {
  constexpr Real kFar = std::numeric_limits<Real>::infinity();
  Vec3 min = Vec3::Constant(kFar);
  Vec3 max = Vec3::Constant(-kFar);
  for (const PublishedState::Body& body : state.bodies) {
    for (const Vec3& position : body.positions) {
      min = min.cwiseMin(position);
      max = max.cwiseMax(position);
    }
  }
  if ((min.array() > max.array()).any()) return;  // no particles
  if (!empty_ && (min.array() >= min_.array()).all() && (max.array() <= max_.array()).all()) return;
  const Vec3 slack = 0.25 * (max - min);
  include(min - slack, max + slack);
}

void FrameDomain::include(const Vec3& min, const Vec3& max) {
  min_ = empty_ ? min : Vec3(min_.cwiseMin(min));
  max_ = empty_ ? max : Vec3(max_.cwiseMax(max));
  empty_ = false;
}

FrameGrid FrameDomain::grid(double max_error) const {
  return make_frame_grid(min_, max_, max_error);
}

}  // namespace vat
