#include "core/forces/vat_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vat {

VatMotion vat_motion(const Vat& vat, Real time) {
  if (!vat.motion) return {};
  const SlideMotion& slide = *vat.motion;
  const Vec3 axis = slide.axis.normalized();
  const Real rate = 2 * std::numbers::pi / slide.period;
  const Real half_stroke = slide.stroke / 2;
  return {axis * (half_stroke * (1 - std::cos(rate * time))),
          axis * (half_stroke * rate * std::sin(rate * time)),
          axis * (half_stroke * rate * rate * std::cos(rate * time))};
}

bool moves_walls(const Vat& vat) {
  if (vat.motion && vat.motion->stroke > 0) return true;
  return std::ranges::any_of(vat.walls, [](const Wall& wall) { return !wall.velocity.isZero(0); });
}

}  // namespace vat
