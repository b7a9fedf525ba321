#include "tests/validation/order.h"

#include <cmath>
#include <stdexcept>

namespace vat::validation {

Real theoretical_order(IntegratorId integrator) {
  switch (integrator) {
    case IntegratorId::explicit_euler:
    case IntegratorId::symplectic_euler:
      return 1;
    case IntegratorId::velocity_verlet:
    case IntegratorId::heun:
      return 2;
    case IntegratorId::runge_kutta_4:
      return 4;
  }
  throw std::invalid_argument("no such integrator");
}

Real observed_order(const std::vector<Real>& sizes, const std::vector<Real>& errors) {
  if (sizes.size() != errors.size() || sizes.size() < 2) {
    throw std::invalid_argument("an order needs at least two pairs of size and error");
  }
  const auto count = static_cast<Real>(sizes.size());
  Real x = 0;
  Real y = 0;
  Real xx = 0;
  Real xy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Real log_size = std::log(sizes[i]);
    const Real log_error = std::log(errors[i]);
    x += log_size;
    y += log_error;
    xx += log_size * log_size;
    xy += log_size * log_error;
  }
  return (count * xy - x * y) / (count * xx - x * x);
}

Real fitted_frequency(const std::vector<Real>& samples, Real interval) {
  Real numerator = 0;
  Real denominator = 0;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    numerator += samples[i] * (samples[i + 1] + samples[i - 1]);
    denominator += samples[i] * samples[i];
  }
  return std::acos(numerator / (2 * denominator)) / interval;
}

}  // namespace vat::validation
