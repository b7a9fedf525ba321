#pragma once

#include <span>
#include <vector>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// Volume fraction of the world that particles fill in coupled liquids.
namespace vat {

/// Returns whether solids and walls contribute to the SPH sums of liquids. Otherwise, solids and
/// walls exert spring forces on liquids.
inline bool couples_liquids(PressureSolver solver) {
  return solver != PressureSolver::gas;
}

/// Returns the volumes of the particles of body `body` of the scene [m^3]. The volume of a liquid
/// particle is mass / rest density. Particles of a solid have equal parts of the volume of the
/// shape. Explicit particles have the volumes of the cubes around them.
std::vector<Real> particle_volumes(const Scene& scene, std::size_t body, const SampledBody& sample);

/// Returns whether bodies fill at least 0.999 of a closed world, which is closed by periodic axes
/// and by the walls of a vat with a lid. Liquid in a filled world has no free surface.
bool fills_world(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
