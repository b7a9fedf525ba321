#pragma once

#include "core/scene/scene.h"

namespace vat {

/// An upper bound of the oscillations x'' + rate x' + omega2 x = 0 of a part of a scene.
struct Oscillation {
  Real omega2 = 0;  ///< [1/s^2]
  Real rate = 0;    ///< damping / mass [1/s]
  bool operator==(const Oscillation&) const = default;
};
inline Oscillation operator+(const Oscillation& a, const Oscillation& b) {
  return {a.omega2 + b.omega2, a.rate + b.rate};
}

/// The step [s] up to which the integrator does not amplify the oscillation: infinite if no step
/// amplifies it, 0 if all do (undamped, with explicit Euler or Heun). Symplectic Euler evaluates
/// damping at the velocity half a step before, and needs (omega dt)^2 + 2 rate dt <= 4. Velocity
/// Verlet solves for it, and needs omega dt <= 2. The limits of the others follow from their
/// stability polynomials.
Real stable_step(IntegratorId integrator, const Oscillation& oscillation);

}  // namespace vat
