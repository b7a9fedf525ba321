#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat::validation {

inline constexpr std::array kIntegrators = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
    IntegratorId::heun, IntegratorId::runge_kutta_4};

/// Returns the theoretical order of convergence of the state at a given time for a smooth problem.
Real theoretical_order(IntegratorId integrator);

/// Returns p of error = C size^p, by least squares of the logarithms. `sizes` are steps or
/// spacings, at least two, all different. A zero error gives a non-finite order.
Real observed_order(const std::vector<Real>& sizes, const std::vector<Real>& errors);

/// Returns the angular frequency [rad/s] of an undamped sine sampled at equal intervals, from the
/// least-squares fit of x(t + interval) + x(t - interval) = 2 cos(omega interval) x(t).
Real fitted_frequency(const std::vector<Real>& samples, Real interval);

/// Returns the angular frequency [rad/s] near `guess` at the maximum of the samples' spectrum. A
/// Hann window suppresses other frequencies at a distance of at least four periods of the whole
/// record.
Real spectral_frequency(const std::vector<Real>& samples, Real interval, Real guess);

}  // namespace vat::validation
