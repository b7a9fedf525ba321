#pragma once

#include "core/scene/numerics.h"

namespace vat {

/// Returns the phase omega dt for which the relative error of phase and amplitude is `error` per
/// radian of an undamped oscillation. The leading error terms per radian, with z = omega dt, are:
///
/// - explicit Euler: the amplitude grows by z/2;
/// - Heun: phase error z^2/6;
/// - symplectic Euler and velocity Verlet: the phase is z^2/24 ahead; velocities of symplectic
///   Euler lag by half a step, which is an error of z/2;
/// - Runge-Kutta 4: phase error z^4/120.
///
/// (E. Hairer, Ch. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., ch. I and IX.)
Real resolving_phase(IntegratorId integrator, Real error);

/// Returns the phase omega dt for an error of positions only, which step control uses to choose
/// steps. Symplectic Euler has the same positions as velocity Verlet, and the same velocities at
/// the beginning and end of a contact.
Real resolving_phase_of_places(const Numerics& numerics);

/// Returns whether step control estimates the error of a step. Otherwise, the tolerance has an
/// effect on contacts only: local control keeps the rest stable, and an integrator with one
/// evaluation for each step has nothing to compare.
bool estimates_errors(const Numerics& numerics);

}  // namespace vat
