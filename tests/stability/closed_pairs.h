#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// Conservation errors of a run of a closed scene.
struct ClosedRun {
  std::string name;
  Real momentum = 0;          ///< maximum |dP|, relative to the initial sum of m |v|
  Real angular_momentum = 0;  ///< maximum |dL|, relative to the initial sum of m |x| |v|
  Real exchanged =
      0;  ///< maximum change of one body's momentum, relative to the initial sum of m |v|
  Real contact_energy = 0;  ///< maximum [J]
  std::uint64_t undone = 0;
  std::uint64_t hash = 0;
};

/// Returns a scene of two blocks of these kinds and different materials in a spinning rigid cage.
/// They collide repeatedly, and no external force acts. Viscosity is 0, because the viscous force
/// acts along the velocity difference and not along the line between particles. It would change
/// angular momentum.
Scene make_closed_pair(BodyKind first, BodyKind second);
/// Returns the scenes of the six pairings.
std::vector<Scene> closed_pairs();

ClosedRun run_closed(const Scene& scene, std::uint32_t steps);

}  // namespace vat::stability
