#include "protocol/messages/describe.h"

#include <algorithm>
#include <cmath>

#include "core/sampling/lattice.h"
#include "core/support/check.h"
#include "protocol/files/text.h"
#include "protocol/scene/appearance.h"
#include "protocol/scene/scene_json.h"

namespace vat {
namespace {

Json to_triples_json(std::span<const Vec3> vectors) {
  Json list = Json::array();
  list.get_ref<Json::array_t&>().reserve(vectors.size());
  for (const Vec3& vector : vectors) list.push_back(to_json(vector));
  return list;
}

Json to_flat_json(std::span<const Vec3> vectors) {
  Json list = Json::array();
  list.get_ref<Json::array_t&>().reserve(3 * vectors.size());
  for (const Vec3& vector : vectors) {
    for (int axis = 0; axis < 3; ++axis) list.push_back(vector[axis]);
  }
  return list;
}

/// Returns the shape, displaced by `origin`.
Shape displaced(Shape shape, const Vec3& origin) {
  const auto displace = [&](auto& s) {
    if constexpr (requires { s.center; }) {
      s.center += origin;
    } else if constexpr (requires { s.vertices; }) {
      for (Vec3& vertex : s.vertices) vertex += origin;
    }
  };
  std::visit(displace, shape);
  return shape;
}

/// Adds the members with which a client can draw the surface of a solid.
void describe_shape(const BodyView& body, const BodyDescription& described, int dimensions,
                    Json& description) {
  const bool is_rigid = body.kind == BodyKind::rigid;
  if (is_rigid) description["local_positions"] = to_flat_json(body.local_positions);
  if (std::holds_alternative<ParticleShape>(described.shape)) return;
  const Vec3 origin = is_rigid ? body.shape_origin : Vec3(Vec3::Zero());
  description["shape"] = write_shape(displaced(described.shape, origin));
  description["shape"].erase("source");
  if (is_rigid) return;
  const Lattice lattice = make_lattice(described.shape, described.spacing, dimensions);
  std::vector<Vec3> rest;
  for (const LatticePoint& point : fill_lattice(described.shape, lattice)) {
    rest.push_back(point.position);
  }
  description["rest_positions"] = to_flat_json(rest);
  description["spacing"] = described.spacing;
}

Json describe_body(const BodyView& body, const BodyDescription& described, int dimensions) {
  Json description{
      {"body", body.id},
      {"name", body.name},
      {"kind", to_string(body.kind)},
      {"material", body.material},
      {"particles", body.positions.size()},
      {"radius", body.radii.empty() ? 0 : *std::ranges::max_element(body.radii)},
  };
  if (body.kind != BodyKind::liquid) describe_shape(body, described, dimensions, description);
  return description;
}

}  // namespace

Json describe_bodies(const Simulation& simulation) {
  const Scene& scene = simulation.scene();
  const std::vector<BodyView> bodies = simulation.bodies();
  VAT_CHECK(bodies.size() == scene.bodies.size());
  Json list = Json::array();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    list.push_back(describe_body(bodies[b], scene.bodies[b], scene.dimensions));
  }
  return list;
}

Json describe_materials(const Scene& scene) {
  Json list = Json::array();
  for (const Material& material : scene.materials) {
    Json description{{"name", material.name},
                     {"appearance", write_appearance(full_appearance(material))}};
    if (material.tearing_strain) description["tearing_strain"] = *material.tearing_strain;
    list.push_back(std::move(description));
  }
  return list;
}

Json describe_vat(const std::optional<Vat>& vat) {
  if (!vat) return nullptr;
  return {{"min", to_json(vat->min)}, {"max", to_json(vat->max)}, {"lid", vat->lid}};
}

Json describe_state(const BodyView& body) {
  Json state{
      {"body", body.id},
      {"name", body.name},
      {"kind", to_string(body.kind)},
      {"positions", to_triples_json(body.positions)},
      {"velocities", to_triples_json(body.velocities)},
  };
  if (!body.numbers.empty())
    state["numbers"] = std::vector(body.numbers.begin(), body.numbers.end());
  if (body.pose) {
    state["center_of_mass"] = to_json(body.pose->center_of_mass);
    state["orientation"] = to_json(body.pose->orientation);
    state["velocity"] = to_json(body.pose->velocity);
    state["angular_velocity"] = to_json(body.pose->angular_velocity);
  }
  return state;
}

namespace {

/// Short as text.
Real rounded(Real value) {
  constexpr Real kDigits = 4;
  if (value == 0 || !std::isfinite(value)) return 0;
  const Real scale = std::pow(Real{10}, kDigits - 1 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) ? std::round(value * scale) / scale : value;
}

}  // namespace

Json describe_connections(const ConnectionList& list, const char* values) {
  Json pairs = Json::array();
  Json numbers = Json::array();
  pairs.get_ref<Json::array_t&>().reserve(4 * list.sample.size());
  numbers.get_ref<Json::array_t&>().reserve(list.sample.size());
  for (const ConnectedPair& connection : list.sample) {
    for (const ConnectedParticle& end : {connection.a, connection.b}) {
      pairs.push_back(end.body);
      pairs.push_back(end.particle);
    }
    numbers.push_back(rounded(connection.value));
  }
  return {{"total", list.total},
          {"every", list.every},
          {"pairs", std::move(pairs)},
          {values, std::move(numbers)}};
}

Json describe_diagnostics(const Diagnostics& diagnostics) {
  Vec3 momentum = Vec3::Zero();
  Vec3 angular_momentum = Vec3::Zero();
  for (const BodyDiagnostics& body : diagnostics.bodies) {
    momentum += body.linear_momentum;
    angular_momentum += body.angular_momentum;
  }
  Json json = {{"kinetic_energy", diagnostics.kinetic_energy},
               {"gravitational_energy", diagnostics.gravitational_energy},
               {"elastic_energy", diagnostics.elastic_energy},
               {"contact_energy", diagnostics.contact_energy},
               {"momentum", to_json(momentum)},
               {"angular_momentum", to_json(angular_momentum)},
               {"mean_density_error", diagnostics.mean_density_error},
               {"max_density_error", diagnostics.max_density_error},
               {"torn_springs", diagnostics.torn_springs},
               {"emitted_particles", diagnostics.emitted_particles},
               {"drained_particles", diagnostics.drained_particles}};
  if (diagnostics.axle_torque) json["axle_torque"] = *diagnostics.axle_torque;
  return json;
}

Json describe_guard(const GuardEvent& event, std::uint64_t tick) {
  return {{"tick", tick},       {"cause", to_string(event.cause)}, {"time", event.time},
          {"body", event.body}, {"particle", event.particle},      {"recovered", event.recovered}};
}

std::string describe_hash(std::uint64_t hash) {
  std::string digits;
  append_hash(digits, hash);
  return digits;
}

}  // namespace vat
