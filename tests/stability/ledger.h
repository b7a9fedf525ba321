#pragma once

#include "core/simulation/simulation.h"

namespace vat::stability {

/// Books of momentum and energy of a simulation whose steps are added one by one. What gravity and
/// the walls give is computed here, from the particles' places and velocities alone, and not taken
/// from the core.
class Ledger {
 public:
  explicit Ledger(const Simulation& simulation);

  /// After each step; `now` are the simulation's diagnostics.
  void add_step(const Simulation& simulation, const Diagnostics& now);

  /// Whether momentum must add up to round-off: the kicks of velocity Verlet are the trapezoidal
  /// rule of the forces of walls without damping and friction.
  static bool closes(const Scene& scene);

  /// Greatest |P - P_0 - impulses| over the sum of what was moved, both ways.
  Real momentum_error() const { return momentum_error_; }
  /// What of momentum_error() round-off explains: 1e-12 of sums, and that of overlaps, which are
  /// differences of coordinates, times the walls' stiffness: a body at rest rounds alike each time.
  Real momentum_bound() const;
  /// Greatest E - E_0 - work of the walls, over the greatest energy in motion and springs.
  Real energy_excess() const { return energy_excess_ / energy_scale_; }
  /// What of energy_excess() there may be. A symplectic integrator keeps a modified energy, which
  /// differs from the true one by at most z^2 (K / 6 + U / 12) for velocity Verlet and z / 2 (K +
  /// U) for symplectic Euler, z = omega dt, at the start and at the end, and as much again for the
  /// work's quadrature. Liquids have pressure's energy besides: k e^2 / 2 per mass at the density
  /// error e, and twice that since their two kernels have no common energy.
  Real energy_bound() const;

 private:
  struct Outside {
    Vec3 force;     ///< of gravity and walls on everything [N]
    Real power;     ///< of the walls [W]
    Real rounding;  ///< greatest round-off of the walls' forces [N]
  };
  static Outside outside(const Simulation& simulation);
  static Real mechanical(const Diagnostics& now);

  const Scene scene_;
  Vec3 momentum_;  ///< of the start and all impulses since
  Real energy_;    ///< of the start and the walls' work since
  Outside last_;
  Real moved_ = 0;     ///< sum of the magnitudes of what was added to momentum
  Real rounding_ = 0;  ///< greatest round-off of the walls' impulses
  Real phase_ = 0;     ///< omega dt of the fastest part
  Real momentum_error_ = 0;
  Real energy_excess_ = -1e300;
  Real energy_scale_ = 1e-300;
  Real liquid_energy_ = 0;  ///< of pressure, at most [J]
};

}  // namespace vat::stability
