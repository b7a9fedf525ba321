#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// What a closed scene kept.
struct ClosedRun {
  std::string name;
  Real momentum = 0;          ///< greatest |dP| over the sum of m |v| at the start
  Real angular_momentum = 0;  ///< greatest |dL| over the sum of m |x| |v| at the start
  Real exchanged = 0;         ///< greatest change of one body's momentum over the sum of m |v|
  Real contact_energy = 0;    ///< greatest seen [J]
  std::uint64_t undone = 0;
  std::uint64_t hash = 0;
};

/// Two blocks of these kinds, of different materials, in a spinning rigid cage in empty space: they
/// meet each other and the cage again and again, and nothing outside acts. Viscosity is 0: the
/// viscous force between two particles is along their velocities' difference and not along the
/// line between them, which changes angular momentum.
Scene make_closed_pair(BodyKind first, BodyKind second);
/// The six pairings.
std::vector<Scene> closed_pairs();

ClosedRun run_closed(const Scene& scene, std::uint32_t steps);

}  // namespace vat::stability
