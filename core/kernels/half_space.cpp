#include "core/kernels/half_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vat {
namespace {

// Integrals over planes. The integral of C (h^2 - r^2)^3 over the plane at distance s is pi/4 C
// (h^2 - s^2)^4.
Real filling_of_space(Real q) {
  const Real q2 = q * q;
  return 0.5 - Real{315} / 256 * q *
                   (1 - q2 * (Real{4} / 3 - q2 * (Real{6} / 5 - q2 * (Real{4} / 7 - q2 / 9))));
}

// Over the line at distance s: 32/35 C (h^2 - s^2)^(7/2), with s = h cos(angle).
Real filling_of_plane(Real q) {
  const Real sine2 = 1 - q * q;
  const Real sum = 1 + sine2 * (Real{2} / 3 + sine2 * (Real{8} / 15 + sine2 * (Real{16} / 35)));
  return (std::acos(q) - q * std::sqrt(sine2) * sum) / std::numbers::pi;
}

// h times the integral of s A(s) over s >= d. In space, A(s) = pi C/3 (h - s)^2 (h + 2s).
Real drag_of_space(Real q) {
  const Real rest = 1 - q;
  return 0.75 * rest * rest * rest * (3 + q * (9 + 8 * q));
}

// In the plane, A(s) = C (h w - s^2 ln((h + w) / s)) with w^2 = h^2 - s^2.
Real drag_of_plane(Real q) {
  const Real w = std::sqrt(1 - q * q);
  const Real q4 = q * q * q * q;
  const Real logarithm = q > 0 ? q4 * std::log((1 + w) / q) : 0;
  return 40 / std::numbers::pi * (5 * w * w * w / 12 - w / 4 + logarithm / 4);
}

}  // namespace

Real HalfSpace::filling(Real d) const {
  const Real q = std::max(Real{0}, d / h_);
  if (q >= 1) return 0;
  return std::max(Real{0}, dimensions_ == 3 ? filling_of_space(q) : filling_of_plane(q));
}

Real HalfSpace::drag(Real d) const {
  const Real q = std::max(Real{0}, d / h_);
  if (q >= 1) return 0;
  const Real integral = std::max(Real{0}, dimensions_ == 3 ? drag_of_space(q) : drag_of_plane(q));
  return integral / (h_ * h_ * std::max(q, kMinDistance));
}

}  // namespace vat
