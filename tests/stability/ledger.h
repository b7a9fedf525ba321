#pragma once

#include "core/simulation/simulation.h"

namespace vat::stability {

/// Balances of momentum and energy of a simulation, step by step. The forces of gravity and walls
/// are computed here from positions and velocities, independently of the core.
class Ledger {
 public:
  explicit Ledger(const Simulation& simulation);

  /// Adds a step after it was taken. `now` are the simulation's diagnostics.
  void add_step(const Simulation& simulation, const Diagnostics& now);

  /// Returns whether the momentum balance holds up to round-off. The kicks of velocity Verlet are
  /// the trapezoidal rule of wall forces without damping and friction. With local steps, walls also
  /// act between the ends of steps.
  static bool closes(const Scene& scene);

  /// Returns the maximum of |P - P_0 - impulses|, relative to the sum of the absolute impulses.
  Real momentum_error() const { return momentum_error_; }
  /// Returns the part of momentum_error() that round-off explains: 1e-12 of the sums, and the
  /// rounding of overlaps times the walls' stiffness. Overlaps are differences of coordinates, and
  /// a body at rest rounds in the same direction in each step.
  Real momentum_bound() const;
  /// Returns the maximum of E - E_0 - work of the walls, relative to the maximum kinetic and
  /// elastic energy.
  Real energy_excess() const { return energy_excess_ / energy_scale_; }
  /// Returns the bound of energy_excess(). A symplectic integrator conserves a modified energy.
  /// With z = omega dt, it differs from the true energy by at most z^2 (K / 6 + U / 12) for
  /// velocity Verlet and z / 2 (K + U) for symplectic Euler. This applies to the start, to the end,
  /// and to the quadrature of the work. Pressure in liquids adds k e^2 / 2 per mass at the density
  /// error e, twice, because their two kernels have no common energy.
  Real energy_bound() const;

 private:
  struct Outside {
    Vec3 force;     ///< gravity and walls [N]
    Real power;     ///< walls [W]
    Real rounding;  ///< maximum round-off of the wall forces [N]
  };
  static Outside outside(const Simulation& simulation);
  static Real mechanical(const Diagnostics& now);

  const Scene scene_;
  Vec3 momentum_;  ///< initial momentum plus all impulses
  Real energy_;    ///< initial energy plus the work of the walls
  Outside last_;
  Real moved_ = 0;     ///< sum of the absolute impulses
  Real rounding_ = 0;  ///< maximum round-off of the wall impulses
  Real phase_ = 0;     ///< omega dt of the fastest part
  Real momentum_error_ = 0;
  Real energy_excess_ = -1e300;
  Real energy_scale_ = 1e-300;
  Real liquid_energy_ = 0;  ///< maximum pressure energy [J]
};

}  // namespace vat::stability
