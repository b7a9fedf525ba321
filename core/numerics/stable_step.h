#pragma once

#include "core/scene/scene.h"

namespace vat {

/// An upper bound of the oscillations x'' + rate x' + omega2 x = 0 of part of a scene.
struct Oscillation {
  Real omega2 = 0;  ///< [1/s^2]
  Real rate = 0;    ///< damping by mass [1/s]
  bool operator==(const Oscillation&) const = default;
};
inline Oscillation operator+(const Oscillation& a, const Oscillation& b) {
  return {a.omega2 + b.omega2, a.rate + b.rate};
}

/// The step [s] up to which the integrator does not let the oscillation grow: infinite where
/// nothing grows, 0 where it grows at any step (undamped, with explicit Euler or Heun). Symplectic
/// Euler takes the damping at the velocity half a step before, and needs (omega dt)^2 + 2 rate dt
/// <= 4; velocity Verlet solves for it, and needs omega dt <= 2; of the others it is where their
/// stability polynomial leaves the unit circle.
Real stable_step(IntegratorId integrator, const Oscillation& oscillation);

}  // namespace vat
