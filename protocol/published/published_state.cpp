#include <algorithm>

#include "core/support/check.h"
#include "protocol/published/published_state.h"

namespace vat {
namespace {

void put_speeds(const BodyView& view, std::vector<float>& speeds) {
  speeds.reserve(view.velocities.size());
  for (const Vec3& velocity : view.velocities) {
    speeds.push_back(static_cast<float>(velocity.norm()));
  }
}

/// Resets all fields. Keeps the capacity of the arrays.
void clear(PublishedState::Body& body) {
  body.positions.clear();
  body.center_of_mass = {};
  body.orientation = {1, 0, 0, 0};
  body.bounding_radius = 0;
  body.numbers.clear();
  for (std::vector<float>& column : body.attributes) column.clear();
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

void publish_particles(const Simulation& simulation, const BodyView& view,
                       const ByAttribute<bool>& wanted, LiquidFields& fields,
                       PublishedState::Body& body) {
  const bool speed = wanted[0];
  const bool density = wanted[1];
  const bool pressure = wanted[2];
  body.positions.assign(view.positions.begin(), view.positions.end());
  body.numbers.assign(view.numbers.begin(), view.numbers.end());
  if (speed) put_speeds(view, body.attributes[0]);
  if (view.kind != BodyKind::liquid || !(density || pressure)) return;
  const Status measured = simulation.measure_liquid(view.id, fields);
  VAT_CHECK(measured.ok());
  if (density) body.attributes[1].assign(fields.density.begin(), fields.density.end());
  if (pressure) body.attributes[2].assign(fields.pressure.begin(), fields.pressure.end());
}

}  // namespace

void StatePublisher::publish(const Simulation& simulation, const ByAttribute<bool>& wanted,
                             PublishedState& state) {
  state.header = {};
  state.header.time = simulation.time();
  state.has_vat = simulation.scene().vat.has_value();
  state.vat_offset = simulation.vat_offset();
  simulation.list_bodies(views_);
  state.bodies.resize(views_.size());
  for (std::size_t b = 0; b < views_.size(); ++b) {
    const BodyView& view = views_[b];
    PublishedState::Body& body = state.bodies[b];
    clear(body);
    body.id = view.id;
    body.kind = view.kind;
    if (view.kind == BodyKind::rigid) {
      publish_pose(view, body);
    } else {
      publish_particles(simulation, view, wanted, fields_, body);
      if (wanted[3]) put_accelerations(view, body.attributes[3]);
    }
  }
}

void StatePublisher::remember(const Simulation& simulation, Real seconds) {
  simulation.list_bodies(views_);
  remembered_.resize(views_.size());
  for (std::size_t b = 0; b < views_.size(); ++b) {
    remembered_[b].id = views_[b].id;
    remembered_[b].velocities.assign(views_[b].velocities.begin(), views_[b].velocities.end());
    remembered_[b].numbers.assign(views_[b].numbers.begin(), views_[b].numbers.end());
  }
  seconds_ = seconds;
}

void StatePublisher::forget() {
  seconds_ = 0;
}

void StatePublisher::put_accelerations(const BodyView& view,
                                       std::vector<float>& accelerations) const {
  const std::size_t count = view.velocities.size();
  accelerations.assign(count, 0);
  const auto found = std::ranges::find(remembered_, view.id, &Remembered::id);
  if (seconds_ == 0 || found == remembered_.end()) return;
  const auto& [id, velocities, numbers] = *found;
  std::size_t j = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Index number = view.numbers.empty() ? static_cast<Index>(i) : view.numbers[i];
    if (numbers.empty()) {
      j = number;
    } else {
      while (j < numbers.size() && numbers[j] < number) ++j;
    }
    if (j >= velocities.size() || (!numbers.empty() && numbers[j] != number)) continue;
    accelerations[i] = static_cast<float>((view.velocities[i] - velocities[j]).norm() / seconds_);
  }
}

PublishedState publish(const Simulation& simulation, const ByAttribute<bool>& wanted) {
  PublishedState state;
  StatePublisher().publish(simulation, wanted, state);
  return state;
}

}  // namespace vat
