// Commands by which users build: they move bodies and the vat, and change materials.

#include <algorithm>
#include <cmath>

#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/scene/interface_table.h"
#include "core/scene/range_check.h"
#include "core/simulation/connections.h"
#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/state/rigid_motion.h"
#include "core/validation/validate.h"

namespace vat {
namespace {

Vec3 center_of(std::span<const Vec3> positions, std::span<const Real> masses) {
  Vec3 sum = Vec3::Zero();
  Real mass = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    sum += masses[i] * positions[i];
    mass += masses[i];
  }
  return sum / mass;
}

Status out_of_range(const std::string& path, const std::string& range) {
  return Error{"out_of_range", path, "must be " + range};
}

/// Checks the numbers of a placement, independent of the scene.
Status check_placement(const BodyPlacement& place, const ModelBody& body, int dimensions) {
  if (!are_at_most(place.center_of_mass, kMaxLength)) {
    return out_of_range("/position", "three finite numbers of magnitude at most 1e6");
  }
  if (place.velocity && !(place.velocity->norm() <= kMaxSpeed)) {
    return out_of_range("/velocity", "finite and at most 1e4 m/s");
  }
  if (place.orientation && body.kind != BodyKind::rigid) {
    return Error{"not_allowed", "/orientation", "only a rigid body has one"};
  }
  const Quat turned = place.orientation.value_or(Quat::Identity());
  const bool is_turn = std::isfinite(turned.norm()) && std::abs(turned.norm() - 1) <= 0.01;
  if (!is_turn) return out_of_range("/orientation", "a quaternion of length 1, up to rounding");
  if (dimensions == 3) return {};
  if (place.velocity && place.velocity->y() != 0) {
    return Error{"off_plane", "/velocity", "must have y = 0 in a scene of two dimensions"};
  }
  if (turned.x() != 0 || turned.z() != 0) {
    return Error{"off_plane", "/orientation", "must rotate about y in a scene of two dimensions"};
  }
  return {};
}

/// Checks the velocity of a placement against the guidance of the body.
Status check_guided_velocity(const BodyPlacement& place, const BodyDescription& body) {
  if (!place.velocity || place.velocity->isZero(0)) return {};
  if (body.motion) return Error{"not_allowed", "/velocity", "must be 0: the body is driven"};
  if (body.axle) return Error{"not_allowed", "/velocity", "must be 0: the body has an axle"};
  return {};
}

/// The new pose of a rigid body, or the shift of another body.
struct Move {
  Vec3 shift = Vec3::Zero();  ///< [m]
  Vec3 center = Vec3::Zero();
  Quat orientation = Quat::Identity();  ///< rigid bodies

  Vec3 place(const BodyView& view, std::size_t particle) const {
    if (!view.pose) return view.positions[particle] + shift;
    return center + orientation * view.local_positions[particle];
  }
};

Move make_move(const BodyView& view, const BodyPlacement& place) {
  if (!view.pose) {
    const Vec3 shift = place.center_of_mass - center_of(view.positions, view.masses);
    return {shift, place.center_of_mass, Quat::Identity()};
  }
  const Quat orientation = place.orientation.value_or(view.pose->orientation).normalized();
  return {place.center_of_mass - view.pose->center_of_mass, place.center_of_mass, orientation};
}

/// The description of the body at its new position.
BodyDescription describe_moved(const Model& model, std::size_t index, const Move& move,
                               const BodyPlacement& place) {
  BodyDescription body = model.scene.bodies[index];
  if (body.kind == BodyKind::rigid) {
    const SampledBody& sample = *model.bodies[index].sample;
    const Quat before = body.orientation.normalized();
    const Vec3 center = center_of(sample.positions, sample.masses) - body.position;
    body.orientation = move.orientation;
    body.position = move.center - move.orientation * (before.conjugate() * center);
  } else {
    body.position += move.shift;
  }
  if (place.velocity) {
    body.velocity = *place.velocity;
    body.angular_velocity = Vec3::Zero();
  }
  return body;
}

void set_motion(const Move& move, const BodyPlacement& place, const Model& model,
                const ModelBody& body, Configuration& now) {
  if (body.kind == BodyKind::rigid) {
    RigidState& state = now.rigid[body.rigid];
    const RigidModel& rigid = model.rigid_bodies[body.rigid];
    const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
    state.center_of_mass = move.center;
    state.orientation = move.orientation;
    state.angular_momentum = angular_momentum_of(rigid, state.orientation, omega);
    if (!place.velocity) return;
    state.momentum = momentum_of(rigid, *place.velocity);
    state.angular_momentum = Vec3::Zero();
    return;
  }
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    now.position[i] += move.shift;
    if (place.velocity && model.inverse_mass[i] > 0) now.velocity[i] = *place.velocity;
  }
}

}  // namespace

Status HostInterface::move_body(BodyId id, const BodyPlacement& placement) {
  const ModelBody* found = impl_->find(id);
  if (found == nullptr) return Error{"no_such_body", "/body", "there is no body with this id"};
  const ModelBody& body = *found;
  const BodyView view = impl_->view_of(body);
  if (body.particles.size() == 0) {
    return Error{"no_particles", "/body", "the body has no particles at present"};
  }
  if (body.sample && !body.sample->in_nozzles.empty()) {
    return Error{"not_allowed", "/body",
                 "a part of the body is in its nozzle; close the nozzle first"};
  }
  const Scene& scene = impl_->all().scene;
  Status status = check_placement(placement, body, scene.dimensions);
  if (!status) return status;
  const auto index = static_cast<std::size_t>(&body - impl_->all().bodies.data());
  status = check_guided_velocity(placement, scene.bodies[index]);
  if (!status) return status;
  const Move move = make_move(view, placement);
  if (scene.dimensions == 2 && std::abs(move.shift.y()) > 0) {
    return Error{"off_plane", "/position", "must stay in the plane y = 0 of the scene"};
  }
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < view.positions.size(); ++i) places.push_back(move.place(view, i));
  BodyDescription moved = describe_moved(impl_->all(), index, move, placement);
  if (!are_at_most(moved.position, kMaxLength)) {
    return out_of_range("/position", "such that the body began within 1e6 m of the origin");
  }
  CurrentScene present = impl_->present();
  present.bodies[index].positions = places;
  if (Errors errors = find_moved_errors(scene, present, index); !errors.empty()) return errors;
  impl_->wake_all();
  impl_->recompile_moved(index, std::move(moved));
  set_motion(move, placement, *impl_->model, impl_->model->bodies[index], impl_->state.now);
  impl_->pose_rigid_particles();
  return {};
}

namespace {

/// The sample of a liquid after a change of its density, for liquids that have flowed or melted,
/// whose particles do not follow from their description. Masses change unless the description
/// contains them.
std::shared_ptr<const SampledBody> with_density(const SampledBody& sample,
                                                const BodyDescription& body, Real ratio) {
  const auto* particles = std::get_if<ParticleShape>(&body.shape);
  const bool is_given = body.mass || (particles != nullptr && !particles->masses.empty());
  if (is_given || ratio == 1) return nullptr;
  auto scaled = std::make_shared<SampledBody>(sample);
  for (Real& mass : scaled->masses) mass *= ratio;
  return scaled;
}

/// The motion of a rigid body, which does not change with its mass.
struct PreservedMotion {
  BodyId body = 0;
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

void restore_motion(const PreservedMotion& kept, const Model& model, Configuration& now) {
  const ModelBody& body = *std::ranges::find(model.bodies, kept.body, &ModelBody::id);
  const RigidModel& rigid = model.rigid_bodies[body.rigid];
  RigidState& state = now.rigid[body.rigid];
  state.momentum = momentum_of(rigid, kept.velocity);
  state.angular_momentum = angular_momentum_of(rigid, state.orientation, kept.angular_velocity);
}

/// Returns whether the length of a nozzle changes, which is the support radius.
bool changes_nozzles(const Scene& scene, const Material& before, const Material& after) {
  if (!before.liquid || !after.liquid) return false;
  if (before.liquid->support_radius == after.liquid->support_radius) return false;
  return std::ranges::any_of(scene.emitters, [&](const Emitter& emitter) {
    const auto body = std::ranges::find(scene.bodies, emitter.body, &BodyDescription::name);
    return body != scene.bodies.end() && body->material == before.name;
  });
}

bool differs_in_appearance_only(const Material& before, const Material& after) {
  Material repainted = before;
  repainted.appearance = after.appearance;
  return repainted == after;
}

std::vector<const SampledBody*> changed_samples(const Model& model) {
  std::vector<const SampledBody*> samples;
  for (const ModelBody& body : model.bodies) {
    samples.push_back(body.is_as_described ? nullptr : body.sample.get());
  }
  return samples;
}

}  // namespace

void SimulationImpl::set_appearance(const std::string& material, const Appearance& appearance) {
  const auto repaint = [&](const Model& before) {
    auto after = std::make_shared<Model>(before);
    after->scene.materials[material_index(after->scene.materials, material)].appearance =
        appearance;
    return after;
  };
  model = repaint(*model);
  if (!sleepers) return;
  const bool is_shown = shown_sleepers == sleepers;
  auto after = std::make_shared<Sleepers>(*sleepers);
  after->model = repaint(*sleepers->model);
  sleepers = std::move(after);
  if (is_shown) shown_sleepers = sleepers;
}

Status HostInterface::set_material(const Material& material) {
  const std::string path = "/material";
  const Model& model = impl_->all();
  const auto before = std::ranges::find(model.scene.materials, material.name, &Material::name);
  const bool is_new = before == model.scene.materials.end();
  if (!is_new && changes_nozzles(model.scene, *before, material)) {
    return Error{"not_allowed", path + "/liquid/support_radius",
                 "must stay, because it is the length of an emitter's nozzle"};
  }
  Errors errors =
      find_material_errors(model.scene, impl_->present(), changed_samples(model), material, path);
  if (!errors.empty()) return errors;
  if (!is_new && differs_in_appearance_only(*before, material)) {
    impl_->set_appearance(material.name, material.appearance);
    return {};
  }
  const Real ratio = is_new ? 1 : material.density / before->density;
  impl_->wake_all();
  std::vector<BodyId> described_anew;
  std::vector<PreservedMotion> motions;
  SimulationImpl::Samples samples(impl_->model->bodies.size());
  for (std::size_t b = 0; b < samples.size(); ++b) {
    const ModelBody& body = impl_->model->bodies[b];
    const BodyDescription& description = impl_->model->scene.bodies[b];
    if (description.material != material.name) continue;
    described_anew.push_back(body.id);
    if (body.sample && !body.is_as_described) {
      samples[b] = with_density(*body.sample, description, ratio);
    }
    if (body.kind != BodyKind::rigid || ratio == 1) continue;
    const RigidPose pose = *impl_->view_of(body).pose;
    motions.push_back({body.id, pose.velocity, pose.angular_velocity});
  }
  impl_->recompile(with_material(impl_->model->scene, material), impl_->ids(), std::move(samples),
                   {}, described_anew);
  for (const PreservedMotion& kept : motions) restore_motion(kept, *impl_->model, impl_->state.now);
  impl_->pose_rigid_particles();
  return {};
}

Status HostInterface::move_vat(const Vec3& offset) {
  Errors errors = find_moved_vat_errors(impl_->all().scene, offset);
  if (!errors.empty()) return errors;
  const std::optional<HandMotion> before = impl_->all().scene.vat->hand;
  if (before ? before->target == offset : offset.isZero(0)) return {};
  impl_->wake_all();
  HandMotion hand;
  hand.start = impl_->time();
  hand.target = offset;
  if (before) {
    const VatMotion now = hand_motion(*before, hand.start);
    hand.offset = now.offset;
    hand.velocity = now.velocity;
  }
  auto model = std::make_shared<Model>(*impl_->model);
  model->scene.vat->hand = hand;
  impl_->model = std::move(model);
  impl_->state.forces_current = false;
  return {};
}

Result<Connections> HostInterface::connections(const ConnectionQuery& query) const {
  if (query.body && impl_->find(*query.body) == nullptr) {
    return Error{"no_such_body", "/body", "there is no body with this id"};
  }
  const ForceModel force_model{impl_->all(),  impl_->controls, impl_->measured,
                               impl_->runner, nullptr,         impl_->state.step_count};
  return find_connections(force_model, impl_->all_now(), impl_->time(), impl_->state.now.contacts,
                          *impl_->model, query);
}

}  // namespace vat
