#include "protocol/frame_codec.h"

namespace vat {
namespace {

PublishedState::Body publish_body(const BodyView& view) {
  PublishedState::Body body{view.id, view.kind, {}, {}, {1, 0, 0, 0}};
  if (view.kind != BodyKind::rigid) {
    body.positions.assign(view.positions.begin(), view.positions.end());
    return body;
  }
  VAT_CHECK(view.pose.has_value());
  const RigidPose& pose = *view.pose;
  body.center_of_mass = {pose.center_of_mass.x(), pose.center_of_mass.y(), pose.center_of_mass.z()};
  const Eigen::Quaternionf orientation = pose.orientation.cast<float>();
  body.orientation = {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
  return body;
}

}  // namespace

PublishedState publish(const Simulation& simulation) {
  PublishedState state;
  state.header.time = simulation.time();
  state.has_vat = simulation.scene().vat.has_value();
  state.vat_offset = simulation.vat_offset();
  const std::vector<BodyView> views = simulation.bodies();
  state.bodies.reserve(views.size());
  for (const BodyView& view : views) state.bodies.push_back(publish_body(view));
  return state;
}

}  // namespace vat
