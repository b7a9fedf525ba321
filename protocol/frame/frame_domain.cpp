#include "protocol/frame/frame_domain.h"

#include <algorithm>
#include <cmath>

#include "core/support/check.h"

namespace vat {
namespace {

using Box = Eigen::AlignedBox<Real, 3>;

constexpr double kSpacingsPerRadius = 2;
constexpr double kErrorsPerSpacing = 64;
constexpr Real kSlack = 0.25;        // on each side, of the width there
constexpr Real kGreatestExcess = 4;  // of the widest side

Real width(const Box& box) {
  return box.sizes().maxCoeff();
}

Box with_slack(const Box& box) {
  const Vec3 slack = kSlack * box.sizes();
  return {box.min() - slack, box.max() + slack};
}

}  // namespace

FrameDomain::FrameDomain(const std::optional<Vat>& vat) {
  if (!vat) return;
  vat_ = Box(vat->min, vat->max);
  if (vat->motion) {
    vat_.extend(vat_.translated(vat->motion->axis.normalized() * vat->motion->stroke));
  }
  box_ = vat_;
}

void FrameDomain::include(const PublishedState& state) {
  Box needed = vat_;
  for (const PublishedState::Body& body : state.bodies) {
    for (const Vec3& position : body.positions) needed.extend(position);
  }
  if (needed.isEmpty()) return;
  if (!box_.contains(needed)) box_.extend(with_slack(needed));
  if (width(box_) > kGreatestExcess * width(needed)) box_ = with_slack(needed);
}

FrameGrid FrameDomain::grid(double max_error) const {
  VAT_CHECK(max_error >= 0);
  if (box_.isEmpty()) return make_frame_grid(Vec3::Zero(), Vec3::Zero(), max_error);
  return make_frame_grid(box_.min(), box_.max(), max_error);
}

FrameGrid FrameDomain::centered_grid(double max_error) const {
  constexpr Real kSteps = 65'535;
  FrameGrid centered = grid(max_error);
  if (box_.isEmpty()) return centered;
  for (int q = 0; q < 3; ++q) {
    const Real unused = kSteps - std::ceil(box_.sizes()[q] / centered.quantum);
    if (unused > 0) {
      centered.origin[static_cast<std::size_t>(q)] -= std::floor(unused / 2) * centered.quantum;
    }
  }
  return centered;
}

double default_max_error(const Simulation& simulation) {
  double least = 0;
  for (const BodyView& body : simulation.bodies()) {
    if (body.kind == BodyKind::rigid || body.radii.empty()) continue;
    const double radius = std::ranges::max(body.radii);
    least = least == 0 ? radius : std::min(least, radius);
  }
  return kSpacingsPerRadius * least / kErrorsPerSpacing;
}

}  // namespace vat
