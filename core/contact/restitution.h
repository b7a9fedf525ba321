#pragma once

#include <cstdint>

#include "core/state/state.h"

namespace vat {

struct StepContext;
class Scratch;

/// Stage: computes the mobilities of contacts that act on a body simultaneously. Their springs add
/// up, and their dashpots must add up to those of one impact: each contact gets the mass that it
/// would move if all acted alike. The result is the velocity that unit impulses of all contacts,
/// walls included, give to each particle.
void find_contact_mobilities(StepContext& context);

/// The result of this stage.
struct ContactMobility {
  const Model& model;
  const Scratch& work;
  const Configuration& at;
  std::uint64_t step;  ///< the present nominal step

  /// The speed along the unit vector `normal` that a unit impulse along it at particle i causes,
  /// together with those of the body's other contacts [1/kg]. At least that without other contacts.
  Real along(Index i, const Vec3& normal) const;
  /// The damping c [N s/m] between particle i and the wall with this normal.
  Real wall_damping(Index i, const Vec3& normal) const;
};

}  // namespace vat
