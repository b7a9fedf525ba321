#pragma once

#include "core/damping/dampers.h"
#include "core/evaluation/force_model.h"

namespace vat {

/// Velocities or forces, with one entry for each particle and for each rigid body. Velocities of
/// rigid particles follow from the velocities of their bodies. Forces on rigid bodies follow from
/// the forces on their particles.
struct Motion {
  std::vector<Vec3> particle;
  std::vector<Vec3> linear;
  std::vector<Vec3> angular;
};

/// A rigid body in the solve, in world axes. The inverse mass and inertia of a held body are zero.
struct DampedBody {
  Real mass;
  Real inverse_mass;
  Mat3 inertia;
  Mat3 inverse_inertia;
};

/// Sums over one block or over all blocks.
struct DampingSums {
  Real error = 0;  ///< <r, M^-1 r> of the residual r
  Real size = 0;   ///< <v - from, M (v - from)>

  DampingSums& operator+=(const DampingSums& other) {
    error += other.error;
    size += other.size;
    return *this;
  }
};

/// Moments of the velocities of free particles and rigid bodies.
struct MomentSums {
  Real mass = 0;
  Vec3 momentum = Vec3::Zero();
  Real square = 0;  ///< <v, M v>

  MomentSums& operator+=(const MomentSums& other) {
    mass += other.mass;
    momentum += other.momentum;
    square += other.square;
    return *this;
  }

  /// Returns <v - V, M (v - V)> with the mean velocity V.
  Real spread() const { return mass > 0 ? square - momentum.squaredNorm() / mass : 0; }
};

/// Tolerances of the error of w in solve_damping(), in the norm of M.
inline constexpr Real kDampingTolerance = 1e-2;          ///< relative to v - from
inline constexpr Real kDampingVelocityTolerance = 3e-4;  ///< relative to velocities minus mean
inline constexpr int kMaxDampingPasses = 200;

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
  std::vector<Real> partial_sums;     ///< indexed by block
  std::vector<DampingSums> sums;      ///< indexed by block
  std::vector<MomentSums> moments;    ///< indexed by block
};

/// Returns an upper bound of the frequencies and damping rates of springs, of liquids, and of the
/// contacts of the last evaluation. For each particle and rigid body, its own bound and the bounds
/// of its contacts are added. The result is the maximum of these sums.
Oscillation find_bound(const ForceModel& force_model, const Configuration& at);

/// Returns the bound of find_bound() without contacts, of bodies with free particles.
Oscillation find_bound_of_bodies(const Model& model);

/// Returns whether velocity Verlet must solve for the damping in a step of `dt` [s]. A solve is not
/// needed if (omega dt)^2 + 4 rate dt <= 4, because forces at predicted velocities are then stable.
bool must_solve_damping(const Oscillation& bound, Real dt);

/// Converts `forces` to the forces at the velocities v after the step: M (v - from) = dt (f + D (v
/// - at)). The forces f were evaluated at `at`, with velocities close to v. `from` has the
/// velocities before the forces act. `dt` is the duration of the action [s]: half a step for
/// velocity Verlet, a whole step for symplectic Euler. The equation is linear in w = v - at, and is
/// solved by conjugate gradients. The iterations end if the error of w meets one of the tolerances,
/// or after kMaxDampingPasses. D w is a sum of equal and opposite forces, so that momentum is
/// conserved after any number of iterations. Requires the dampers of an evaluation with
/// Scratch::keep_dampers. Rigid bodies must have the same motion in `at` and `from`.
void solve_damping(const ForceModel& force_model, const Configuration& from, Configuration& at,
                   Real time, Real dt, bool viscosity, Forces& forces, DampingScratch& scratch);

/// Returns whether the viscosity of any liquid requires a solve in a step of `dt` [s].
bool must_solve_viscosity(const Model& model, Real dt);

/// Returns whether the damping of any body, without its contacts, requires a solve in a step of
/// `dt` [s]. This damping includes the drag of solids in liquids.
bool must_solve_own_damping(const Model& model, Real dt);

}  // namespace vat
