// The commands that set positions and velocities of a body.

#include <cmath>

#include "core/limits.h"
#include "core/scene/interface_table.h"
#include "core/scene/range_check.h"
#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"
#include "core/validation/validate.h"

namespace vat {
namespace {

Status wrong(const std::string& member, const std::string& range) {
  return Error{"out_of_range", "/state/" + member, "must be " + range};
}

Status check_pose(const RigidPose& pose, int dimensions) {
  if (!are_at_most(pose.center_of_mass, kMaxLength)) {
    return wrong("center_of_mass", "three finite numbers of magnitude at most 1e6");
  }
  const bool is_turn =
      std::isfinite(pose.orientation.norm()) && std::abs(pose.orientation.norm() - 1) <= 0.001;
  if (!is_turn) return wrong("orientation", "a quaternion of length 1, up to rounding");
  if (!(pose.velocity.norm() <= kMaxSpeed)) return wrong("velocity", "at most 1e4 m/s");
  if (!are_at_most(pose.angular_velocity, kMaxAngularSpeed)) {
    return wrong("angular_velocity", "three finite numbers of magnitude at most 1e4");
  }
  if (dimensions == 3) return {};
  const bool is_in_plane = pose.center_of_mass.y() == 0 && pose.velocity.y() == 0 &&
                           pose.orientation.x() == 0 && pose.orientation.z() == 0 &&
                           pose.angular_velocity.x() == 0 && pose.angular_velocity.z() == 0;
  if (is_in_plane) return {};
  return Error{"off_plane", "/state", "must stay in the plane y = 0 of the scene"};
}

Status check_columns(const BodyMotion& motion, std::size_t particles, int dimensions) {
  const std::string as_many = std::to_string(particles) + " vectors, one for each particle";
  if (motion.positions.size() != particles) return wrong("positions", as_many);
  if (motion.velocities.size() != particles) return wrong("velocities", as_many);
  for (std::size_t i = 0; i < particles; ++i) {
    const std::string at = '/' + std::to_string(i);
    if (!are_at_most(motion.positions[i], kMaxLength)) {
      return wrong("positions" + at, "three finite numbers of magnitude at most 1e6");
    }
    if (!(motion.velocities[i].norm() <= kMaxSpeed)) {
      return wrong("velocities" + at, "finite and at most 1e4 m/s");
    }
    if (dimensions == 2 && (motion.positions[i].y() != 0 || motion.velocities[i].y() != 0)) {
      return Error{"off_plane", "/state", "must stay in the plane y = 0 of the scene"};
    }
  }
  return {};
}

Status check_motion(const BodyMotion& motion, BodyKind kind, std::size_t particles,
                    int dimensions) {
  if (kind != BodyKind::rigid) return check_columns(motion, particles, dimensions);
  if (!motion.pose) return Error{"missing", "/state", "a rigid body needs its pose"};
  return check_pose(*motion.pose, dimensions);
}

/// The positions of a rigid body's particles in this pose.
std::vector<Vec3> posed(const SampledBody& sample, const BodyDescription& body,
                        const RigidPose& pose) {
  Vec3 center = Vec3::Zero();
  Real mass = 0;
  for (std::size_t i = 0; i < sample.positions.size(); ++i) {
    center += sample.masses[i] * sample.positions[i];
    mass += sample.masses[i];
  }
  VAT_CHECK(mass > 0 && body.kind == BodyKind::rigid);
  center /= mass;
  const Quat turn = pose.orientation.normalized() * body.orientation.normalized().conjugate();
  std::vector<Vec3> places;
  for (const Vec3& place : sample.positions) {
    places.push_back(pose.center_of_mass + turn * (place - center));
  }
  return places;
}

void set_motion(const BodyMotion& motion, const Model& model, const ModelBody& body,
                Configuration& now) {
  if (body.kind == BodyKind::rigid) {
    VAT_CHECK(motion.pose.has_value() && body.rigid < now.rigid.size());
    const RigidModel& rigid = model.rigid_bodies[body.rigid];
    RigidState& state = now.rigid[body.rigid];
    state.center_of_mass = motion.pose->center_of_mass;
    state.orientation = motion.pose->orientation.normalized();
    state.momentum = momentum_of(rigid, motion.pose->velocity);
    state.angular_momentum =
        angular_momentum_of(rigid, state.orientation, motion.pose->angular_velocity);
    return;
  }
  VAT_CHECK(motion.positions.size() == body.particles.size());
  VAT_CHECK(motion.velocities.size() == body.particles.size());
  for (Index i = 0; i < body.particles.size(); ++i) {
    const Index particle = body.particles.begin + i;
    now.position[particle] = motion.positions[i];
    if (model.inverse_mass[particle] > 0) now.velocity[particle] = motion.velocities[i];
  }
}

}  // namespace

std::optional<RigidMomentum> HostInterface::rigid_momentum(BodyId id) const {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr || body->kind != BodyKind::rigid) return {};
  const RigidState& state = impl_->all_now().rigid[body->rigid];
  return RigidMomentum{state.momentum, state.angular_momentum};
}

Status HostInterface::set_body_motion(BodyId id, const BodyMotion& motion) {
  const ModelBody* found = impl_->find(id);
  if (found == nullptr) return Error{"no_such_body", "/body", "there is no body with this id"};
  if (found->kind == BodyKind::rigid) {
    const RigidModel& rigid = impl_->all().rigid_bodies[found->rigid];
    if (rigid.is_held(impl_->state.step_count) || rigid.axle) {
      return Error{"not_allowed", "/body", "must be neither held, driven nor on an axle"};
    }
  }
  const int dimensions = impl_->all().scene.dimensions;
  const Status status = check_motion(motion, found->kind, found->particles.size(), dimensions);
  if (!status) return status;
  impl_->wake_all();
  const ModelBody& body = *impl_->find(id);
  set_motion(motion, *impl_->model, body, impl_->state.now);
  if (body.kind == BodyKind::rigid) {
    const RigidModel& rigid = impl_->model->rigid_bodies[body.rigid];
    pose_rigid_body(*impl_->model, rigid, impl_->state.now.rigid[body.rigid], impl_->state.now);
  }
  impl_->state.forces_current = false;
  impl_->stepper.forget();
  return {};
}

Result<BodyId> HostInterface::add_body(const BodyDescription& body, const BodyMotion& motion) {
  Scene scene = impl_->all().scene;
  Scene open = scene;
  open.vat.reset();  // its initial position may be outside the present vat
  Errors errors = find_body_errors(open, impl_->present(), body, "/body");
  if (!errors.empty()) return errors;
  const Material& material = scene.materials[material_index(scene.materials, body.material)];
  const SampledBody sample = sample_body(body, material, scene.dimensions);
  const std::size_t particles = sample.positions.size();
  const Status status = check_motion(motion, body.kind, particles, scene.dimensions);
  if (!status) return status.errors();
  const bool is_rigid = body.kind == BodyKind::rigid;
  const auto places = is_rigid ? posed(sample, body, *motion.pose) : motion.positions;
  CurrentScene present = impl_->present();
  present.bodies.push_back({places, sample.radii, sample.springs.size()});
  scene.bodies.push_back(body);
  errors = find_returned_errors(scene, present);
  for (Error& error : errors) error.path = "/state";
  if (!errors.empty()) return errors;
  impl_->wake_all();
  std::vector<BodyId> ids = impl_->ids();
  const BodyId id = impl_->next_id++;
  ids.push_back(id);
  impl_->recompile(std::move(scene), ids);
  set_motion(motion, *impl_->model, impl_->model->bodies.back(), impl_->state.now);
  impl_->pose_rigid_particles();
  return id;
}

}  // namespace vat
