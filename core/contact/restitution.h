#pragma once

#include <cstdint>

#include "core/state/state.h"

namespace vat {

struct StepContext;
class Scratch;

/// Stage: how contacts share what they push. Where n of them push one body at once their springs
/// add up, and so must their dashpots to those of one impact: each gets the mass that it would move
/// if all pushed alike. The result is the velocity that unit impulses of all its contacts, walls
/// included, give each particle.
void find_contact_mobilities(StepContext& context);

/// What that stage found.
struct ContactMobility {
  const Model& model;
  const Scratch& work;
  const Configuration& at;
  std::uint64_t step;  ///< the nominal step being taken

  /// The speed along the unit vector `normal` that a unit impulse along it at particle i gives
  /// that, with those of the body's other contacts [1/kg]; no less than by itself.
  Real along(Index i, const Vec3& normal) const;
  /// c [N s/m] between particle i and the wall with this normal.
  Real wall_damping(Index i, const Vec3& normal) const;
};

}  // namespace vat
