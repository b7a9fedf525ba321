#include "core/numerics/stable_step.h"

#include <cmath>
#include <complex>
#include <limits>

#include "core/support/check.h"

namespace vat {
namespace {

using Complex = std::complex<Real>;

/// 1 + w + w^2/2 + ... + w^order/order!: the approximation of exp(w) by a step of an explicit
/// Runge-Kutta method of this order with as many stages.
Complex growth(int order, Complex w) {
  Complex sum = 1;
  Complex term = 1;
  for (int k = 1; k <= order; ++k) {
    term *= w / static_cast<Real>(k);
    sum += term;
  }
  return sum;
}

bool is_stable(int order, const Oscillation& oscillation, Real dt) {
  constexpr Real kRounding = 1e-12;
  const Complex half = oscillation.rate / 2;
  const Complex root = std::sqrt(half * half - Complex(oscillation.omega2));
  return std::norm(growth(order, dt * (-half + root))) <= 1 + kRounding &&
         std::norm(growth(order, dt * (-half - root))) <= 1 + kRounding;
}

/// By bisection: along a ray into the left half-plane both methods are stable up to one point, at
/// |w| < 3.
Real runge_kutta_limit(int order, const Oscillation& oscillation) {
  Real low = 0;
  Real high = 6 / std::max(std::sqrt(oscillation.omega2), oscillation.rate);  // |w| >= rate / 2
  for (int halving = 0; halving < 40; ++halving) {
    const Real middle = (low + high) / 2;
    (is_stable(order, oscillation, middle) ? low : high) = middle;
  }
  return low;
}

/// The limit |1 + w|^2 <= 1 in closed form. For weakly damped oscillations it is far below that of
/// other methods.
Real explicit_euler_limit(const Oscillation& oscillation) {
  const Real half = oscillation.rate / 2;
  const Real discriminant = half * half - oscillation.omega2;
  if (discriminant <= 0) return oscillation.rate / oscillation.omega2;
  return 2 / (half + std::sqrt(discriminant));
}

/// The root of omega2 dt^2 + 2 rate dt = 4, in a form that is exact if one of them is zero.
Real symplectic_euler_limit(const Oscillation& oscillation) {
  const Real rate = oscillation.rate;
  return 4 / (rate + std::sqrt(rate * rate + 4 * oscillation.omega2));
}

}  // namespace

Real stable_step(IntegratorId integrator, const Oscillation& oscillation) {
  VAT_CHECK(!(oscillation.omega2 < 0) && !(oscillation.rate < 0));
  if (oscillation.omega2 == 0 && oscillation.rate == 0) {
    return std::numeric_limits<Real>::infinity();
  }
  switch (integrator) {
    case IntegratorId::symplectic_euler:
      return symplectic_euler_limit(oscillation);
    case IntegratorId::velocity_verlet:
      return 2 / std::sqrt(oscillation.omega2);
    case IntegratorId::explicit_euler:
      return explicit_euler_limit(oscillation);
    case IntegratorId::heun:
      return oscillation.rate == 0 ? 0 : runge_kutta_limit(2, oscillation);
    case IntegratorId::runge_kutta_4:
      return runge_kutta_limit(4, oscillation);
  }
  VAT_CHECK(false && "not an integrator");
  return 0;
}

}  // namespace vat
