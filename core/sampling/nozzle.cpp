#include "core/sampling/nozzle.h"

#include <algorithm>
#include <cmath>

#include "core/sampling/lattice.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kIntervalRounding = 1e-6;  // of an interval between two layers

/// The opening in its own axes, with z along the flow, and the depth of one layer.
Shape opening_of(const Emitter& emitter, Real spacing, int dimensions) {
  if (emitter.size)
    return BoxShape{Vec3::Zero(), {(*emitter.size)[0], (*emitter.size)[1], spacing}};
  const Real radius = emitter.radius.value_or(0);
  if (dimensions == 2) return BoxShape{Vec3::Zero(), {2 * radius, spacing, spacing}};
  return CylinderShape{Vec3::Zero(), Vec3::UnitZ(), radius, spacing};
}

/// Columns: across the flow, across both, along the flow. The first is horizontal, in two
/// dimensions in the plane.
Mat3 axes_of(const Emitter& emitter, int dimensions) {
  const Vec3 along = emitter.direction.normalized();
  Vec3 across =
      dimensions == 2 ? Vec3(Vec3::UnitY().cross(along)) : Vec3(Vec3::UnitZ().cross(along));
  if (across.norm() < 1e-9) across = Vec3::UnitX();
  across.normalize();
  Mat3 axes;
  axes << across, along.cross(across), along;
  return axes;
}

}  // namespace

std::uint64_t Nozzle::entered(Real time) const {
  VAT_CHECK(interval > 0);
  const Real next =
      std::floor((time - from) / interval + static_cast<Real>(inside) + kIntervalRounding) + 1;
  if (!(next > 0)) return 0;
  return next < static_cast<Real>(layers) ? static_cast<std::uint64_t>(next) : layers;
}

Real lattice_points(const Emitter& emitter, Real spacing, int dimensions) {
  return make_lattice(opening_of(emitter, spacing, dimensions), spacing, dimensions).point_count();
}

std::vector<Vec3> layer_of(const Emitter& emitter, Real spacing, int dimensions) {
  const Shape opening = opening_of(emitter, spacing, dimensions);
  const Mat3 axes = axes_of(emitter, dimensions);
  std::vector<Vec3> layer;
  for (const LatticePoint& point :
       fill_lattice(opening, make_lattice(opening, spacing, dimensions))) {
    Vec3 place = point.position;
    place.z() = 0;
    layer.push_back(emitter.position + axes * place);
  }
  return layer;
}

Nozzle make_nozzle(const Scene& scene, const Emitter& emitter) {
  const auto body = std::ranges::find(scene.bodies, emitter.body, &BodyDescription::name);
  VAT_CHECK(body != scene.bodies.end());
  const Material& material = material_of(scene, *body);
  VAT_CHECK(body->kind == BodyKind::liquid && body->spacing > 0 && material.liquid);
  Nozzle nozzle;
  nozzle.layer = layer_of(emitter, body->spacing, scene.dimensions);
  nozzle.velocity = emitter.speed * emitter.direction.normalized();
  nozzle.mass = material.density * std::pow(body->spacing, scene.dimensions);
  nozzle.interval = body->spacing / emitter.speed;
  nozzle.inside =
      static_cast<std::uint64_t>(std::ceil(material.liquid->support_radius / body->spacing));
  nozzle.from = emitter.from;
  nozzle.layers = static_cast<std::uint64_t>(
      std::ceil((emitter.until - emitter.from) / nozzle.interval - kIntervalRounding));
  return nozzle;
}

std::size_t most_particles(const Scene& scene, const BodyDescription& body) {
  std::size_t most = 0;
  for (const Emitter& emitter : scene.emitters) {
    if (emitter.body == body.name) most = std::max(most, emitter.most_particles);
  }
  return most;
}

}  // namespace vat
