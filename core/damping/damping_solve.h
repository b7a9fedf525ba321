#pragma once

#include "core/damping/dampers.h"
#include "core/evaluation/force_model.h"

namespace vat {

/// One entry for each particle, and for each rigid body: velocities, or forces. Rigid particles'
/// velocities follow from their bodies', and bodies' forces from their particles'.
struct Motion {
  std::vector<Vec3> particle;
  std::vector<Vec3> linear;
  std::vector<Vec3> angular;
};

/// A rigid body as the solve sees it, in world axes. What is held does not yield.
struct DampedBody {
  Real mass;
  Real inverse_mass;
  Mat3 inertia;
  Mat3 inverse_inertia;
};

/// Sums over one block, or over all.
struct DampingSums {
  Real error = 0;  ///< <r, M^-1 r> of the residual r
  Real size = 0;   ///< <w, M w>

  DampingSums& operator+=(const DampingSums& other) {
    error += other.error;
    size += other.size;
    return *this;
  }
};

/// Scratch of solve_damping().
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
  std::vector<DampingSums> sums;      ///< the same
};

/// An upper bound of the oscillations that springs, liquids and the contacts of the last evaluation
/// allow: of each particle, or rigid body, the sum of its own and of all its contacts.
Oscillation find_bound(const ForceModel& force_model, const Configuration& at);

/// Whether velocity Verlet must solve for the damping in a step of `dt`; where it need not, forces
/// at predicted velocities are stable too, which takes (omega dt)^2 + 4 rate dt <= 4.
bool must_solve_damping(const Oscillation& bound, Real dt);

/// Changes `forces`, evaluated at `at` with velocities near those at the end of a step, into those
/// at the velocities v that they lead to: M (v - from) = dt (f + D (v - at)), with `from` the
/// velocities that forces over `dt` begin from: half a step of velocity Verlet's, or a whole one of
/// symplectic Euler's. Linear in what acts at `at`; by conjugate gradients for w = v - at.
/// D w is a sum of equal and opposite forces, so momentum is conserved after any number of
/// iterations. Needs the dampers that the workspace kept; the rigid bodies of `at` move as those of
/// `from`.
void solve_damping(const ForceModel& force_model, const Configuration& from,
                   const Configuration& at, Real time, Real dt, bool viscosity, Forces& forces,
                   DampingScratch& scratch);

/// Whether the viscosity of some liquid takes part in that.
bool must_solve_viscosity(const Model& model, Real dt);

/// The same of what liquids do to solids in them too: of any body's own damping.
bool must_solve_own_damping(const Model& model, Real dt);

}  // namespace vat
