#pragma once

#include "core/scene/scene.h"

namespace vat {

/// The phase omega dt at which the integrator's relative error of phase and amplitude is `error`
/// per radian of an undamped oscillation. Leading terms, z = omega dt: explicit Euler grows by z/2
/// and Heun turns by z^2/6 too little or too much; symplectic Euler and velocity Verlet turn by
/// z^2/24 too much, and the former's velocities are those of half a step before, z/2; Runge-Kutta 4
/// turns by z^4/120. (E. Hairer, Ch. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed.,
/// ch. I and IX.)
Real resolving_phase(IntegratorId integrator, Real error);

/// The same for an error of places alone, which varied steps are chosen for: the places of
/// symplectic Euler are those of velocity Verlet, and where a contact begins or ends so are its
/// velocities.
Real resolving_phase_of_places(const Numerics& numerics);

}  // namespace vat
