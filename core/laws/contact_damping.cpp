#include "core/laws/contact_damping.h"

#include <cmath>
#include <numbers>

#include "core/support/check.h"

namespace vat {

Real restitution_of(Real damping_ratio) {
  const Real zeta = damping_ratio;
  const Real s2 = (1 - zeta) * (1 + zeta);
  if (std::abs(s2) < 1e-8) return std::exp(Real{-2});  // the limit of both expressions
  const Real s = std::sqrt(std::abs(s2));
  if (zeta > 1) return std::exp(-zeta / s * std::log((zeta + s) / (zeta - s)));
  return std::exp(-zeta / s * (std::numbers::pi - std::atan2(2 * zeta * s, 1 - 2 * zeta * zeta)));
}

/// By bisection: e falls as zeta grows, and is about 1 / (4 zeta^2) for large zeta.
Real damping_ratio_for(Real restitution) {
  VAT_CHECK(restitution > 0);
  if (restitution >= 1) return 0;
  Real low = 0;
  Real high = 1 + 1 / std::sqrt(restitution);
  for (int halving = 0; halving < 60; ++halving) {
    const Real middle = (low + high) / 2;
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return high;
}

Real damping_for(Real damping_ratio, Real stiffness, Real mobility) {
  VAT_CHECK(damping_ratio >= 0 && stiffness >= 0);
  return mobility > 0 ? 2 * damping_ratio * std::sqrt(stiffness / mobility) : 0;
}

}  // namespace vat
