#pragma once

#include "core/damping/dampers.h"
#include "core/evaluation/force_model.h"

namespace vat {

/// Velocities or forces, with one entry for each particle and for each rigid body. Velocities of
/// rigid particles follow from those of bodies, and forces on bodies from those on particles.
struct Motion {
  std::vector<Vec3> particle;
  std::vector<Vec3> linear;
  std::vector<Vec3> angular;
};

/// A rigid body in the solve, in world axes. A held body has no inverse mass and inertia.
struct DampedBody {
  Real mass;
  Real inverse_mass;
  Mat3 inertia;
  Mat3 inverse_inertia;
};

/// Sums over one block or over all blocks.
struct DampingSums {
  Real error = 0;  ///< <r, M^-1 r> of the residual r
  Real size = 0;   ///< <w, M w>

  DampingSums& operator+=(const DampingSums& other) {
    error += other.error;
    size += other.size;
    return *this;
  }
};

/// Buffers of solve_damping().
struct DampingScratch {
  DampingMatrix matrix;
  std::vector<DampedBody> bodies;
  Motion change;  ///< w
  Motion force;   ///< D w
  Motion residual;
  Motion direction;
  Motion product;                     ///< D times the direction
  std::vector<Vec3> friction_torque;  ///< see DampingMatrix::multiply()
  std::vector<Real> partial_sums;     ///< by block
  std::vector<DampingSums> sums;      ///< by block
};

/// An upper bound of the oscillations of springs, liquids and the contacts of the last evaluation:
/// the maximum over particles and rigid bodies of the sum of their own bound and those of their
/// contacts.
Oscillation find_bound(const ForceModel& force_model, const Configuration& at);

/// Returns whether velocity Verlet must solve for the damping in a step of `dt`. Forces at
/// predicted velocities are stable as well if (omega dt)^2 + 4 rate dt <= 4.
bool must_solve_damping(const Oscillation& bound, Real dt);

/// Changes `forces`, evaluated at `at` with velocities close to those at the end of a step, into
/// the forces at the resulting velocities v: M (v - from) = dt (f + D (v - at)). `from` are the
/// velocities before the forces act for `dt`: half a step of velocity Verlet, or a whole step of
/// symplectic Euler. The equation is linear in w = v - at, and solved by conjugate gradients. D w
/// is a sum of equal and opposite forces, so that momentum is conserved after any number of
/// iterations. Needs the dampers of an evaluation with keep_dampers. The rigid bodies of `at` have
/// the motion of those of `from`.
void solve_damping(const ForceModel& force_model, const Configuration& from,
                   const Configuration& at, Real time, Real dt, bool viscosity, Forces& forces,
                   DampingScratch& scratch);

/// Returns whether the viscosity of some liquid must be solved in a step of `dt`.
bool must_solve_viscosity(const Model& model, Real dt);

/// Returns whether the own damping of some body must be solved in a step of `dt`, including that of
/// solids in liquids.
bool must_solve_own_damping(const Model& model, Real dt);

}  // namespace vat
