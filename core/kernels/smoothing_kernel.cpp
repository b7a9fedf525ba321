#include "core/kernels/smoothing_kernel.h"

#include <numbers>

#include "core/kernels/lattice_sum.h"
#include "core/support/check.h"

namespace vat {
namespace {

struct Constants {
  Real in_space;  ///< C h^3
  Real in_plane;  ///< C h^2
  Real slope;     ///< h^2 slope_over_r() / (C polynomial)
};

Constants constants_of(KernelId id) {
  using std::numbers::pi;
  switch (id) {
    case KernelId::wendland_c2:
      return {21 / (2 * pi), 7 / pi, -20};
    case KernelId::cubic_spline:
      return {8 / pi, 40 / (7 * pi), -6};
  }
  VAT_CHECK(false && "not a kernel");
  return {};
}

}  // namespace

SmoothingKernel::SmoothingKernel(KernelId id, Real h, int dimensions, Real scale)
    : id_(id), inverse_h_(1 / h) {
  VAT_CHECK(h > 0 && (dimensions == 2 || dimensions == 3));
  const Constants constants = constants_of(id);
  scale_ =
      scale * (dimensions == 3 ? constants.in_space / (h * h * h) : constants.in_plane / (h * h));
  slope_scale_ = constants.slope * scale_ / (h * h);
}

Real lattice_sum(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions) {
  return sum_over_lattice(h, spacing, dimensions, [&](Real, Real r) { return kernel.value(r); });
}

Real lattice_slope(const SmoothingKernel& kernel, Real h, Real spacing, int dimensions) {
  return -sum_over_lattice(h, spacing, dimensions,
                           [&](Real x, Real r) { return x * x * kernel.slope_over_r(r); });
}

}  // namespace vat
