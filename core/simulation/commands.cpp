// Commands of users on a running simulation.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "core/limits.h"
#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/support/check.h"
#include "core/support/nearest_name.h"
#include "core/validation/validate.h"

namespace vat {
namespace {

constexpr Real kGrabFrequency = 2 * std::numbers::pi * 2;  // [rad/s]; follows a moving hand
constexpr Real kGrabMaxAcceleration = 200;                 // [m/s^2]
constexpr Real kGrabReach = 3;                             // [particle diameters] held around it
constexpr Real kGrabMaxDampingRatio =
    0.5;  // of the momentum of the held particles in one step; 1 is unstable

Error no_such_body() {
  return {"no_such_body", "/body", "there is no body with this id"};
}

Status check_vector(const Vec3& value, Real limit, const std::string& path) {
  if (value.allFinite() && value.cwiseAbs().maxCoeff() <= limit) return {};
  std::ostringstream message;
  message << "must be three finite numbers of magnitude at most " << limit;
  return Error{"out_of_range", path, message.str()};
}

/// Checks a vector that moves bodies. In two dimensions it must be in the plane.
Status check_in_world(const Scene& scene, const Vec3& value, Real limit, const std::string& path) {
  if (scene.dimensions == 2 && value.y() != 0) {
    return Error{"off_plane", path, "must have y = 0 in a scene of two dimensions"};
  }
  return check_vector(value, limit, path);
}

}  // namespace

Result<BodyId> HostInterface::add_body(const BodyDescription& body) {
  Errors errors = find_body_errors(impl_->all().scene, impl_->present(), body, "/body");
  if (!errors.empty()) return errors;
  impl_->wake_all();
  Scene scene = impl_->model->scene;
  scene.bodies.push_back(body);
  std::vector<BodyId> ids = impl_->ids();
  const BodyId id = impl_->next_id++;
  ids.push_back(id);
  impl_->recompile(std::move(scene), ids);
  return id;
}

Status HostInterface::remove_body(BodyId id) {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return no_such_body();
  impl_->wake_all();
  const auto index = body - impl_->model->bodies.data();
  Scene scene = impl_->model->scene;
  std::vector<BodyId> ids = impl_->ids();
  std::erase_if(scene.emitters, [&](const Emitter& each) { return each.body == body->name; });
  scene.bodies.erase(scene.bodies.begin() + index);
  ids.erase(ids.begin() + index);
  impl_->recompile(std::move(scene), ids);
  return {};
}

Status HostInterface::set_emitter(std::string_view name, bool open) {
  const auto found = std::ranges::find(impl_->all().scene.emitters, name, &Emitter::name);
  if (found == impl_->all().scene.emitters.end()) {
    return unknown_name({}, "/emitter", "must be the name of one of the scene's emitters", name,
                        impl_->all().scene.emitters, &Emitter::name);
  }
  const auto index = found - impl_->all().scene.emitters.begin();
  impl_->wake_all();
  auto model = std::make_shared<Model>(*impl_->model);
  model->scene.emitters[static_cast<std::size_t>(index)].open = open;
  impl_->model = std::move(model);
  return {};
}

Status HostInterface::melt_body(BodyId id, const std::string& material) {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return no_such_body();
  const auto index = static_cast<std::size_t>(body - impl_->all().bodies.data());
  Errors errors = find_melting_errors(impl_->all().scene, impl_->present(), index, material);
  if (!errors.empty()) return errors;
  impl_->wake_all();
  impl_->melt({{index, material}});
  return {};
}

Status HostInterface::set_gravity(const Vec3& gravity) {
  Status status = check_in_world(impl_->model->scene, gravity, kMaxGravity, "/gravity");
  if (!status) return status;
  impl_->wake_all();
  auto model = std::make_shared<Model>(*impl_->model);
  model->scene.gravity = gravity;
  model->damping.is_current = false;
  impl_->model = std::move(model);
  impl_->state.forces_current = false;
  return {};
}

Status HostInterface::set_interface(const InterfaceDescription& interface) {
  Errors errors =
      find_interface_errors(impl_->all().scene, impl_->present(), interface, "/interface");
  if (!errors.empty()) return errors;
  impl_->wake_all();
  Scene scene = impl_->model->scene;
  const auto same_pair = [&](const InterfaceDescription& other) {
    return std::ranges::is_permutation(other.materials, interface.materials);
  };
  const auto found = std::ranges::find_if(scene.interfaces, same_pair);
  if (found == scene.interfaces.end()) {
    scene.interfaces.push_back(interface);
  } else {
    *found = interface;
  }
  impl_->recompile(std::move(scene), impl_->ids());
  return {};
}

Status HostInterface::apply_force(BodyId id, const Vec3& force, Real duration) {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return no_such_body();
  Status status = check_in_world(impl_->model->scene, force, kMaxForce, "/force");
  if (!status) return status;
  if (!(duration > 0 && duration <= kMaxForceTime)) {
    return Error{"out_of_range", "/duration", "must be above 0 and at most 3600 seconds"};
  }
  if (body->particles.size() == 0) {
    return Error{"no_particles", "/body", "the body has no particles at present"};
  }
  if (impl_->controls.applied_forces.size() >= kMaxAppliedForces) {
    return Error{"limit_reached", "",
                 "at most " + std::to_string(kMaxAppliedForces) + " applied forces at once"};
  }
  impl_->wake_all();
  // Rounding must not add a step to a duration of whole steps.
  const Real steps = std::max(Real{1}, std::ceil(duration / impl_->step_size() - 1e-6));
  const Vec3 acceleration = force * (duration / (steps * impl_->step_size() * body->mass));
  impl_->controls.applied_forces.push_back(
      {id, static_cast<Index>(body - impl_->model->bodies.data()), acceleration,
       impl_->state.step_count + static_cast<std::uint64_t>(steps)});
  impl_->state.forces_current = false;
  return {};
}

namespace {

/// The particle itself, and for bodies that are not rigid the particles near it.
std::vector<Index> held_particles(const Model& model, const ModelBody& body,
                                  const Configuration& at, Index particle) {
  if (body.kind == BodyKind::rigid) return {particle};
  const Index first = body.particles.begin;
  const PeriodicBox& box = model.periodic;
  const Vec3 center = box.wrap(at.position[first + particle]);
  const Real reach = kGrabReach * 2 * model.radius[first + particle];
  std::vector<Index> held;
  for (Index i = 0; i < body.particles.size(); ++i) {
    if (box.nearest(box.wrap(at.position[first + i]) - center).norm() <= reach) held.push_back(i);
  }
  return held;
}

/// The minimum mass of the held particles for a force on them; for a rigid body that of the point.
Real felt_mass(const Model& model, const ModelBody& body, const Configuration& at,
               const Grab& grab) {
  if (body.kind != BodyKind::rigid) return grab.held_mass;
  const RigidModel& rigid = model.rigid_bodies[body.rigid];
  const Mat3 r = at.rigid[body.rigid].orientation.toRotationMatrix();
  const Vec3 arm =
      r * model.local_position[body.particles.begin + grab.particle - model.free_count];
  Mat3 cross;
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  // The acceleration of the point by a force on it.
  const Mat3 mobility = rigid.inverse_mass * Mat3::Identity() -
                        cross * r * rigid.inverse_inertia * r.transpose() * cross;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(mobility, Eigen::EigenvaluesOnly);
  return 1 / solver.eigenvalues().maxCoeff();
}

/// Sets the constants of a critically damped spring that moves the whole body, or in a liquid the
/// held particles. The damping is limited, because it must not reverse the velocity of the held
/// particles within a step.
void tune_grab(const Model& model, const ModelBody& body, const Configuration& at, Grab& grab) {
  VAT_CHECK(!grab.held.empty());
  grab.held_mass = 0;
  for (const Index i : grab.held) grab.held_mass += model.mass[body.particles.begin + i];
  const Real most = kGrabMaxDampingRatio * felt_mass(model, body, at, grab) /
                    (2 * kGrabFrequency * model.scene.numerics.step);
  const Real wanted = body.kind == BodyKind::liquid ? grab.held_mass : body.mass;
  const Real mass = std::min(wanted, most);
  grab.stiffness = mass * kGrabFrequency * kGrabFrequency;
  grab.damping = 2 * mass * kGrabFrequency;
  grab.max_force = mass * kGrabMaxAcceleration;
}

}  // namespace

void SimulationImpl::tune_grabs() {
  for (Grab& grab : controls.grabs) tune_grab(*model, model->bodies[grab.body], state.now, grab);
}

Status HostInterface::grab_start(std::uint64_t id, BodyId body_id, Index particle,
                                 const Vec3& target) {
  const ModelBody* body = impl_->find(body_id);
  if (body == nullptr) return no_such_body();
  if (particle >= body->particles.size()) {
    return Error{"out_of_range", "/particle",
                 "must be below " + std::to_string(body->particles.size())};
  }
  if (Status status = check_vector(target, kMaxLength, "/target"); !status) return status;
  std::vector<Grab>& grabs = impl_->controls.grabs;
  const auto known = std::ranges::find(grabs, id, &Grab::id);
  if (known == grabs.end() && grabs.size() >= kMaxGrabs) {
    return Error{"limit_reached", "", "at most " + std::to_string(kMaxGrabs) + " grabs at once"};
  }
  impl_->wake_all();
  Grab grab;
  grab.id = id;
  grab.body_id = body_id;
  grab.body = static_cast<Index>(body - impl_->model->bodies.data());
  grab.particle = particle;
  grab.held = held_particles(*impl_->model, *body, impl_->state.now, particle);
  grab.target = target;
  tune_grab(*impl_->model, *body, impl_->state.now, grab);
  if (known == grabs.end()) {
    grabs.push_back(std::move(grab));
  } else {
    *known = std::move(grab);
  }
  impl_->state.forces_current = false;
  return {};
}

namespace {

Error no_such_grab() {
  return {"no_such_grab", "/grab", "there is no grab with this id"};
}

}  // namespace

Status HostInterface::grab_move(std::uint64_t id, const Vec3& target) {
  const auto grab = std::ranges::find(impl_->controls.grabs, id, &Grab::id);
  if (grab == impl_->controls.grabs.end()) return no_such_grab();
  if (Status status = check_vector(target, kMaxLength, "/target"); !status) return status;
  grab->target = target;
  impl_->state.forces_current = false;
  return {};
}

Status HostInterface::grab_end(std::uint64_t id) {
  if (std::erase_if(impl_->controls.grabs, [&](const Grab& g) { return g.id == id; }) == 0) {
    return no_such_grab();
  }
  impl_->state.forces_current = false;
  return {};
}

std::optional<Vec3> HostInterface::grab_target(std::uint64_t id) const {
  const auto grab = std::ranges::find(impl_->controls.grabs, id, &Grab::id);
  if (grab == impl_->controls.grabs.end()) return {};
  return grab->target;
}

}  // namespace vat
