#pragma once

#include "core/forces/dampers.h"
#include "core/step/force_model.h"

namespace vat {

/// One entry for each particle, and for each rigid body: velocities, or forces. Rigid particles'
/// velocities follow from their bodies', and bodies' forces from their particles'.
struct Motion {
  std::vector<Vec3> particle;
  std::vector<Vec3> linear;
  std::vector<Vec3> angular;
};

/// Scratch of solve_damping().
struct DampingScratch {
  DampingMatrix matrix;
  Motion change;  ///< w
  Motion residual;
  Motion direction;
  Motion inertia;  ///< M times the direction
  Motion product;
  std::vector<Real> partial_sums;  ///< of dot products, by block
};

/// Whether velocity Verlet must solve for the damping in a step of `dt`; where it need not, forces
/// at predicted velocities are stable too, which needs (omega dt)^2 + 4 rate dt <= 4 of every part.
bool must_solve_damping(const Model& model, Real dt);

/// Changes `forces`, evaluated at `at` with the velocities at the half of a step, into those at the
/// velocities that they lead to at its end: the change w obeys M w = dt/2 (f + D w). Linear in what
/// acts at `at`; by conjugate gradients on (M - dt/2 D) w = dt/2 f, from dt/2 M^-1 f on. D w is a
/// sum of equal and opposite forces, so momentum is conserved after any number of iterations.
void solve_damping(const ForceModel& force_model, const Configuration& at, Real time, Real dt,
                   Forces& forces, DampingScratch& scratch);

}  // namespace vat
