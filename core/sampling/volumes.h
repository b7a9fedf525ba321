#pragma once

#include <span>
#include <vector>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// How much of the world particles take up, to liquids that solids take part in.
namespace vat {

/// Whether solids and walls take part in the liquids' sums; otherwise they push with springs.
inline bool couples_liquids(PressureSolver solver) {
  return solver != PressureSolver::gas;
}

/// Of the particles of the scene's body `body`, with this sample [m^3]: of a liquid their mass over
/// the rest density; of a solid equal parts of the shape or, for explicit particles, the cubes
/// about them.
std::vector<Real> particle_volumes(const Scene& scene, std::size_t body, const SampledBody& sample);

/// Whether bodies take up all of a world that is closed, by periodic axes and the walls of a vat
/// with a lid, but for a thousandth: liquid then has no free surface.
bool fills_world(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
