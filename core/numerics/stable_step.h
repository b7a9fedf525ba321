#pragma once

#include "core/scene/numerics.h"

namespace vat {

/// Upper bound of the oscillations x'' + rate x' + omega2 x = 0 of a part of a scene.
struct Oscillation {
  Real omega2 = 0;  ///< [1/s^2]
  Real rate = 0;    ///< damping / mass [1/s]
  bool operator==(const Oscillation&) const = default;
};
inline Oscillation operator+(const Oscillation& a, const Oscillation& b) {
  return {a.omega2 + b.omega2, a.rate + b.rate};
}

/// Returns the step [s] up to which the integrator does not amplify the oscillation. The result is
/// infinite if no step amplifies the oscillation. The result is 0 if all steps amplify it:
/// undamped, with explicit Euler or Heun. Symplectic Euler evaluates damping at the velocity of the
/// previous half step, and requires (omega dt)^2 + 2 rate dt <= 4. Velocity Verlet solves for
/// damping, and requires omega dt <= 2. The limits of the other integrators follow from their
/// stability polynomials.
Real stable_step(IntegratorId integrator, const Oscillation& oscillation);

}  // namespace vat
