#include "server/session/describe.h"

#include <algorithm>

#include "server/output/text.h"

namespace vat {
namespace {

Json to_json(std::span<const Vec3> vectors) {
  Json list = Json::array();
  list.get_ref<Json::array_t&>().reserve(vectors.size());
  for (const Vec3& vector : vectors) list.push_back(vat::to_json(vector));
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

Json describe_body(const BodyView& body) {
  Json description{
      {"body", body.id},
      {"name", body.name},
      {"kind", to_string(body.kind)},
      {"material", body.material},
      {"particles", body.positions.size()},
      {"radius", body.radii.empty() ? 0 : *std::ranges::max_element(body.radii)},
  };
  if (body.kind == BodyKind::rigid) {
    description["local_positions"] = to_flat_json(body.local_positions);
  }
  return description;
}

}  // namespace

Json to_json(const Vec3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json to_json(const Quat& orientation) {
  return {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
}

Json describe_bodies(const Simulation& simulation) {
  Json list = Json::array();
  for (const BodyView& body : simulation.bodies()) list.push_back(describe_body(body));
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
      {"positions", to_json(body.positions)},
      {"velocities", to_json(body.velocities)},
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
