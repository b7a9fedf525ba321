#include "tests/validation/order.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace vat::validation {

namespace {

/// Returns the magnitude of the Fourier transform of the windowed samples.
Real spectrum(const std::vector<Real>& samples, Real phase_step) {
  const Real window_step = 2 * std::numbers::pi / static_cast<Real>(samples.size());
  std::complex<Real> sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto n = static_cast<Real>(i) + 0.5;
    sum += samples[i] * (1 - std::cos(window_step * n)) * std::polar(1.0, -phase_step * n);
  }
  return std::abs(sum);
}

}  // namespace

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

// Golden-section search within one period of the record to each side, where there is one maximum.
Real spectral_frequency(const std::vector<Real>& samples, Real interval, Real guess) {
  const Real golden = (std::sqrt(5.0) - 1) / 2;
  const Real width = 2 * std::numbers::pi / static_cast<Real>(samples.size());
  Real low = guess * interval - width;
  Real high = guess * interval + width;
  while (high - low > 1e-10 * (high + low)) {
    const Real a = high - golden * (high - low);
    const Real b = low + golden * (high - low);
    if (spectrum(samples, a) > spectrum(samples, b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return 0.5 * (low + high) / interval;
}

}  // namespace vat::validation
