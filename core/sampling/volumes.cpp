#include "core/sampling/volumes.h"

#include <cmath>
#include <limits>

#include "core/scene/lookup.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Infinite if an axis is open.
Real world_volume(const Scene& scene) {
  Real volume = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (scene.dimensions == 2 && axis == 1) continue;
    if (scene.periodic && scene.periodic->axes[static_cast<std::size_t>(axis)]) {
      volume *= scene.periodic->max[axis] - scene.periodic->min[axis];
    } else if (scene.vat && scene.forces.walls && (axis < 2 || scene.vat->lid)) {
      volume *= scene.vat->max[axis] - scene.vat->min[axis];
    } else {
      return std::numeric_limits<Real>::infinity();
    }
  }
  return volume;
}

}  // namespace

std::vector<Real> particle_volumes(const Scene& scene, std::size_t body,
                                   const SampledBody& sample) {
  const BodyDescription& description = scene.bodies[body];
  VAT_CHECK(body < scene.bodies.size());
  const std::size_t count = sample.positions.size();
  std::vector<Real> volumes;
  volumes.reserve(count);
  if (description.kind == BodyKind::liquid) {
    const Real density = material_of(scene, description).density;
    for (const Real mass : sample.masses) volumes.push_back(mass / density);
    return volumes;
  }
  const bool is_plane = scene.dimensions == 2;
  const Real shape = is_plane ? shape_area(description.shape) : shape_volume(description.shape);
  if (shape > 0) {
    volumes.assign(count, shape / static_cast<Real>(count));
    return volumes;
  }
  for (const Real radius : sample.radii) volumes.push_back(std::pow(2 * radius, scene.dimensions));
  return volumes;
}

bool fills_world(const Scene& scene, std::span<const SampledBody* const> samples) {
  constexpr Real kFull = 0.999;
  VAT_CHECK(samples.size() == scene.bodies.size());
  Real filled = 0;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    for (const Real volume : particle_volumes(scene, b, *samples[b])) filled += volume;
  }
  return filled >= kFull * world_volume(scene);
}

}  // namespace vat
