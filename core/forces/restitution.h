#pragma once

#include <cstdint>

#include "core/state/state.h"

namespace vat {

struct StepContext;
struct Workspace;

/// The coefficient of restitution e of the unilateral spring and dashpot, which part when their
/// force is zero, of damping ratio zeta = c / (2 sqrt(k m)) (T. Schwager, T. Poeschel, Granular
/// Matter 9 (2007) 465): with s = sqrt(|1 - zeta^2|),
///
///   e = exp(-zeta/s (pi - atan2(2 zeta s, 1 - 2 zeta^2)))   for zeta < 1,
///   e = exp(-zeta/s ln((zeta + s) / (zeta - s)))            for zeta > 1.
Real restitution_of(Real damping_ratio);

/// The damping ratio that has it; `restitution` above 0, at most 1.
Real damping_ratio_for(Real restitution);

/// c [N s/m] of a contact of `stiffness` k and damping ratio zeta between ends that a unit impulse
/// parts with the speed `yielding` [1/kg], the inverse of their reduced mass; 0 where nothing
/// moves.
Real damping_for(Real damping_ratio, Real stiffness, Real yielding);

/// Stage: how contacts share what they push. Where n of them push one body at once their springs
/// add up, and so must their dashpots to those of one impact: each gets the mass that it would move
/// if all pushed alike. The result is the velocity that unit impulses of all its contacts, walls
/// included, give each particle.
void find_yieldings(StepContext& context);

/// What that stage found.
struct Yieldings {
  const Model& model;
  const Workspace& work;
  const Configuration& at;
  std::uint64_t step;  ///< the nominal step being taken

  /// The speed along the unit vector `normal` that a unit impulse along it at particle i gives
  /// that, with those of the body's other contacts [1/kg]; no less than by itself.
  Real along(Index i, const Vec3& normal) const;
  /// c [N s/m] between particle i and the wall with this normal.
  Real wall_damping(Index i, const Vec3& normal) const;
};

}  // namespace vat
