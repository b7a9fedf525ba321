#pragma once

#include <span>
#include <vector>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// The share of the world that particles fill in coupled liquids.
namespace vat {

/// Returns whether solids and walls take part in the sums of liquids. Otherwise they exert spring
/// forces.
inline bool couples_liquids(PressureSolver solver) {
  return solver != PressureSolver::gas;
}

/// Volumes of the particles of the scene's body `body` [m^3]. Liquid: mass / rest density. Solid:
/// equal parts of the volume of the shape; for explicit particles, the cubes around them.
std::vector<Real> particle_volumes(const Scene& scene, std::size_t body, const SampledBody& sample);

/// Returns whether bodies fill at least 0.999 of a world that is closed by periodic axes and the
/// walls of a vat with a lid. Liquid then has no free surface.
bool fills_world(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
