#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat::validation {

inline constexpr std::array kIntegrators = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
    IntegratorId::heun, IntegratorId::runge_kutta_4};

/// Order of convergence by theory, of the state at one time of a smooth problem.
Real theoretical_order(IntegratorId integrator);

/// p of error = C size^p, by least squares over the logarithms. `sizes` are steps or spacings, at
/// least two and all different; a zero error gives no finite order.
Real observed_order(const std::vector<Real>& sizes, const std::vector<Real>& errors);

/// Angular frequency [rad/s] of an undamped sine sampled at equal intervals, from the least-squares
/// fit of x(t + interval) + x(t - interval) = 2 cos(omega interval) x(t).
Real fitted_frequency(const std::vector<Real>& samples, Real interval);

/// Angular frequency [rad/s] near `guess` at which the spectrum of the samples is greatest. A Hann
/// window keeps other frequencies out that are at least four periods of the whole record away.
Real spectral_frequency(const std::vector<Real>& samples, Real interval, Real guess);

}  // namespace vat::validation
