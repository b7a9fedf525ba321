#pragma once

#include <cstdint>

#include "core/state/state.h"

namespace vat {

struct StepContext;
class Scratch;

/// Stage that computes the mobilities of contacts that act on a body simultaneously, walls
/// included. The mobility vector of a particle is its velocity change by simultaneous unit impulses
/// of all contacts of the particle or of its rigid body. With these mobilities, the dashpots of
/// simultaneous contacts have the combined damping that the restitution of one impact requires.
void find_contact_mobilities(StepContext& context);

/// The result of find_contact_mobilities().
struct ContactMobility {
  const Model& model;
  const Scratch& work;
  const Configuration& at;
  std::uint64_t step;  ///< the present nominal step

  /// Returns the speed of particle i along the unit vector `normal` per unit impulse of all
  /// contacts of its body [1/kg]. The result is at least the mobility without other contacts.
  Real along(Index i, const Vec3& normal) const;
  /// Returns the damping c [N s/m] between particle i and the wall with the normal `normal`.
  Real wall_damping(Index i, const Vec3& normal) const;
};

}  // namespace vat
