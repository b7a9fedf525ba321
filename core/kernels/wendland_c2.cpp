#include "core/kernels/wendland_c2.h"

#include <cmath>
#include <numbers>

namespace vat {
WendlandC2::WendlandC2(Real h, int dimensions, Real scale)
    : inverse_h_(1 / h),
      scale_(scale * (dimensions == 3 ? 21 / (2 * std::numbers::pi * h * h * h)
                                      : 7 / (std::numbers::pi * h * h))),
      slope_scale_(-20 * scale_ / (h * h)) {}

namespace {

template <class F>
Real sum_over_lattice(Real h, Real spacing, int dimensions, F&& f) {
  const int reach = static_cast<int>(h / spacing);
  const int depth = dimensions == 3 ? reach : 0;
  Real sum = 0;
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -depth; y <= depth; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Real r = spacing * std::sqrt(static_cast<Real>(x * x + y * y + z * z));
        if (r < h) sum += f(spacing * static_cast<Real>(x), r);
      }
    }
  }
  return sum * std::pow(spacing, dimensions);
}

}  // namespace

Real lattice_sum(const WendlandC2& kernel, Real h, Real spacing, int dimensions) {
  return sum_over_lattice(h, spacing, dimensions, [&](Real, Real r) { return kernel.value(r); });
}

Real lattice_slope(const WendlandC2& kernel, Real h, Real spacing, int dimensions) {
  return -sum_over_lattice(h, spacing, dimensions,
                           [&](Real x, Real r) { return x * x * kernel.slope_over_r(r); });
}

}  // namespace vat
