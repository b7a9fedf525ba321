#include "core/kernels/cohesion_kernel.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/kernels/lattice_sum.h"
#include "core/support/check.h"

namespace vat {
namespace {

using std::numbers::pi;

Real constant_of(Real reach, int dimensions) {
  return dimensions == 3 ? 495 / (32 * pi * reach * reach * reach) : 9 / (pi * reach * reach);
}

struct Node {
  Real place;
  Real weight;
};

/// Gauss-Legendre nodes on [0, 1].
constexpr std::array<Node, 8> kNodes = {{{0.0198550717512319, 0.0506142681451881},
                                         {0.1016667612931866, 0.1111905172266872},
                                         {0.2372337950418355, 0.1568533229389437},
                                         {0.4082826787521751, 0.1813418916891810},
                                         {0.5917173212478249, 0.1813418916891810},
                                         {0.7627662049581645, 0.1568533229389437},
                                         {0.8983332387068134, 0.1111905172266872},
                                         {0.9801449282487681, 0.0506142681451881}}};

/// The integral of w over the plane at distance q, in units of H; in space that of a polynomial,
/// exact.
Real wendland_over_plane(Real q, int dimensions) {
  if (q >= 1) return 0;
  const Real width = std::sqrt(1 - q * q);
  Real sum = 0;
  for (const Node& node : kNodes) {
    if (dimensions == 3) {
      const Real r = q + (1 - q) * node.place;
      sum += node.weight * (1 - q) * 2 * pi * r * CohesionKernel::wendland_c4(r);
    } else {
      const Real x = width * node.place;
      sum += node.weight * width * 2 * CohesionKernel::wendland_c4(std::sqrt(q * q + x * x));
    }
  }
  return sum;
}

}  // namespace

CohesionKernel::CohesionKernel(Real support, Real spacing, int dimensions)
    : dimensions_(dimensions),
      inverse_far_(1 / (kReach * support)),
      inverse_near_(1 / (kCore * support)),
      far_scale_(constant_of(kReach * support, dimensions)),
      near_scale_(constant_of(kCore * support, dimensions)) {
  VAT_CHECK(support > 0 && spacing > 0);
  constexpr Real kSlope = Real{-56} / 3;
  const auto steepness = [&](Real inverse_reach, Real slope) {
    return -sum_over_lattice(1 / inverse_reach, spacing, dimensions, [&](Real x, Real r) {
      return x * x * slope * shape(r * inverse_reach);
    });
  };
  far_slope_ = kSlope * far_scale_ * inverse_far_ * inverse_far_;
  near_slope_ = kSlope * near_scale_ * inverse_near_ * inverse_near_;
  steepness_ = steepness(inverse_far_, far_slope_);
  const Real balance = steepness_ / steepness(inverse_near_, near_slope_);
  near_scale_ *= -balance;
  near_slope_ *= -balance;
}

Real CohesionKernel::over_plane(Real d, Real share) const {
  const auto part = [&](Real scale, Real inverse_reach) {
    return scale * std::pow(inverse_reach, 1 - dimensions_) *
           wendland_over_plane(d * inverse_reach, dimensions_);
  };
  return part(share * far_scale_, inverse_far_) + part(near_scale_, inverse_near_);
}

Real CohesionKernel::first_moment(int dimensions) {
  return dimensions == 3 ? Real{35} / 384 : 16 / (55 * pi);
}

}  // namespace vat
