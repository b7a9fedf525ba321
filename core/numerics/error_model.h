#pragma once

#include "core/scene/scene.h"

namespace vat {

/// The phase omega dt for which the relative error of phase and amplitude is `error` per radian of
/// an undamped oscillation. Leading terms, with z = omega dt: the amplitude of explicit Euler grows
/// by z/2, and the phase of Heun errs by z^2/6. Symplectic Euler and velocity Verlet are z^2/24
/// ahead, and the velocities of the former are those of half a step before, z/2. Runge-Kutta 4 errs
/// by z^4/120. (E. Hairer, Ch. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., ch. I
/// and IX.)
Real resolving_phase(IntegratorId integrator, Real error);

/// The phase for an error of positions only, by which varied steps are chosen. The positions of
/// symplectic Euler are those of velocity Verlet, and so are its velocities at the beginning and
/// end of a contact.
Real resolving_phase_of_places(const Numerics& numerics);

}  // namespace vat
