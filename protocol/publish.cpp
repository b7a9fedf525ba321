#include "protocol/published_state.h"

namespace vat {
namespace {

template <class Values>
std::vector<float> to_floats(const Values& values) {
  return {values.begin(), values.end()};
}

std::vector<float> speeds_of(const BodyView& view) {
  std::vector<float> speeds;
  speeds.reserve(view.velocities.size());
  for (const Vec3& velocity : view.velocities) {
    speeds.push_back(static_cast<float>(velocity.norm()));
  }
  return speeds;
}

void publish_particles(const Simulation& simulation, const BodyView& view,
                       const ByAttribute<bool>& wanted, PublishedState::Body& body) {
  const auto [speed, density, pressure] = wanted;
  body.positions.assign(view.positions.begin(), view.positions.end());
  body.numbers.assign(view.numbers.begin(), view.numbers.end());
  if (speed) body.attributes[0] = speeds_of(view);
  if (view.kind != BodyKind::liquid || !(density || pressure)) return;
  const LiquidFields fields = simulation.liquid_fields(view.id).value();
  if (density) body.attributes[1] = to_floats(fields.density);
  if (pressure) body.attributes[2] = to_floats(fields.pressure);
}

void publish_pose(const BodyView& view, PublishedState::Body& body) {
  VAT_CHECK(view.pose.has_value());
  const Vec3& center = view.pose->center_of_mass;
  const Quat& orientation = view.pose->orientation;
  body.center_of_mass = {center.x(), center.y(), center.z()};
  body.orientation = {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
  for (const Vec3& position : view.local_positions) {
    body.bounding_radius = std::max(body.bounding_radius, position.norm());
  }
}

}  // namespace

PublishedState publish(const Simulation& simulation, const ByAttribute<bool>& wanted) {
  PublishedState state;
  state.header.time = simulation.time();
  state.has_vat = simulation.scene().vat.has_value();
  state.vat_offset = simulation.vat_offset();
  const std::vector<BodyView> views = simulation.bodies();
  state.bodies.reserve(views.size());
  for (const BodyView& view : views) {
    PublishedState::Body& body = state.bodies.emplace_back();
    body.id = view.id;
    body.kind = view.kind;
    if (view.kind == BodyKind::rigid) {
      publish_pose(view, body);
    } else {
      publish_particles(simulation, view, wanted, body);
    }
  }
  return state;
}

}  // namespace vat
