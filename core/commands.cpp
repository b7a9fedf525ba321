// The commands of Simulation: what users change while it runs.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/limits.h"
#include "core/model/compile.h"
#include "core/scene/validate.h"
#include "core/simulation.h"
#include "core/simulation_impl.h"

namespace vat {
namespace {

constexpr Real kGrabFrequency = 2 * std::numbers::pi * 2;  // [rad/s] follows a hand, never stiff
constexpr Real kGrabMaxAcceleration = 200;                 // [m/s^2]
constexpr Real kGrabReach = 3;                             // [particle diameters] held around it

Error no_such_body() {
  return {"no_such_body", "/body", "there is no body with this id"};
}

Status check_vector(const Vec3& value, Real limit, const std::string& path) {
  if (value.allFinite() && value.cwiseAbs().maxCoeff() <= limit) return {};
  return Error{"out_of_range", path,
               "must be three finite numbers of magnitude at most " + std::to_string(limit)};
}

/// Copies the state of a body from one model's columns to another's.
void carry_over(const ModelBody& from, const Configuration& source, const ModelBody& to,
                Configuration& target) {
  for (Index i = 0; i < from.particles.size(); ++i) {
    target.position[to.particles.begin + i] = source.position[from.particles.begin + i];
    target.velocity[to.particles.begin + i] = source.velocity[from.particles.begin + i];
  }
  if (from.kind == BodyKind::rigid) {
    target.rigid[to.rigid] = source.rigid[from.rigid];
  }
}

}  // namespace

void Simulation::Impl::recompile(Scene scene, const std::vector<BodyId>& ids) {
  std::vector<std::shared_ptr<const SampledBody>> samples;
  for (const BodyId id : ids) {
    const ModelBody* known = find(id);
    samples.push_back(known == nullptr ? nullptr : known->sample);
  }
  const State old_state = std::move(state);
  auto new_model = compile(std::move(scene), ids, std::move(samples));
  State new_state = initial_state(*new_model);
  for (const ModelBody& body : new_model->bodies) {
    const ModelBody* known = find(body.id);
    if (known != nullptr) carry_over(*known, old_state.now, body, new_state.now);
  }
  new_state.step_count = old_state.step_count;
  state = std::move(new_state);
  model = std::move(new_model);
  work = {};
  measured = {};
  for (std::size_t b = 0; b < model->bodies.size(); ++b) {
    const auto index = static_cast<Index>(b);
    for (Grab& grab : controls.grabs) {
      if (grab.body_id == model->bodies[b].id) grab.body = index;
    }
    for (AppliedForce& applied : controls.applied_forces) {
      if (applied.body_id == model->bodies[b].id) applied.body = index;
    }
  }
}

namespace {

std::vector<BodyId> ids_of(const Model& model) {
  std::vector<BodyId> ids;
  for (const ModelBody& body : model.bodies) ids.push_back(body.id);
  return ids;
}

}  // namespace

Result<BodyId> Simulation::add_body(const BodyDescription& body) {
  Errors errors = find_body_errors(impl_->model->scene, body, "/body");
  if (!errors.empty()) return errors;
  Scene scene = impl_->model->scene;
  scene.bodies.push_back(body);
  std::vector<BodyId> ids = ids_of(*impl_->model);
  const BodyId id = impl_->next_id++;
  ids.push_back(id);
  impl_->recompile(std::move(scene), ids);
  return id;
}

Status Simulation::remove_body(BodyId id) {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return no_such_body();
  const auto index = body - impl_->model->bodies.data();
  Scene scene = impl_->model->scene;
  std::vector<BodyId> ids = ids_of(*impl_->model);
  scene.bodies.erase(scene.bodies.begin() + index);
  ids.erase(ids.begin() + index);
  std::erase_if(impl_->controls.grabs, [&](const Grab& grab) { return grab.body_id == id; });
  std::erase_if(impl_->controls.applied_forces,
                [&](const AppliedForce& applied) { return applied.body_id == id; });
  impl_->recompile(std::move(scene), ids);
  return {};
}

Status Simulation::set_gravity(const Vec3& gravity) {
  if (Status status = check_vector(gravity, kMaxGravity, "/gravity"); !status) return status;
  Scene scene = impl_->model->scene;
  scene.gravity = gravity;
  impl_->controls.gravity = gravity;
  impl_->recompile(std::move(scene), ids_of(*impl_->model));
  return {};
}

Status Simulation::set_interface(const InterfaceDescription& interface) {
  Scene scene = impl_->model->scene;
  const auto same_pair = [&](const InterfaceDescription& other) {
    return std::ranges::is_permutation(other.materials, interface.materials);
  };
  const auto found = std::ranges::find_if(scene.interfaces, same_pair);
  const auto index = static_cast<std::size_t>(found - scene.interfaces.begin());
  if (found == scene.interfaces.end()) {
    scene.interfaces.push_back(interface);
  } else {
    *found = interface;
  }
  const std::string prefix = "/interfaces/" + std::to_string(index);
  Errors errors = find_errors(scene);
  for (Error& error : errors) {
    if (error.path.starts_with(prefix))
      error.path = "/interface" + error.path.substr(prefix.size());
  }
  if (!errors.empty()) return errors;
  impl_->recompile(std::move(scene), ids_of(*impl_->model));
  return {};
}

Status Simulation::apply_force(BodyId id, const Vec3& force, Real duration) {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return no_such_body();
  if (Status status = check_vector(force, kMaxMass, "/force"); !status) return status;
  if (!(duration > 0 && duration <= kMaxForceTime)) {
    return Error{"out_of_range", "/duration", "must be above 0 and at most 3600 seconds"};
  }
  if (impl_->controls.applied_forces.size() >= kMaxAppliedForces) {
    return Error{"limit_reached", "",
                 "at most " + std::to_string(kMaxAppliedForces) + " applied forces at once"};
  }
  impl_->controls.applied_forces.push_back({id,
                                            static_cast<Index>(body - impl_->model->bodies.data()),
                                            force / body->mass, impl_->time() + duration});
  impl_->state.forces_current = false;
  return {};
}

namespace {

/// The particle itself, and of bodies that are not rigid those near it at present.
std::vector<Index> held_particles(const Model& model, const ModelBody& body,
                                  const Configuration& at, Index particle) {
  if (body.kind == BodyKind::rigid) return {particle};
  const Index first = body.particles.begin;
  const Vec3 center = at.position[first + particle];
  const Real reach = kGrabReach * 2 * model.radius[first + particle];
  std::vector<Index> held;
  for (Index i = 0; i < body.particles.size(); ++i) {
    if ((at.position[first + i] - center).norm() <= reach) held.push_back(i);
  }
  return held;
}

/// Constants of a critically damped spring for the mass that it must move.
void tune_grab(const Model& model, const ModelBody& body, Grab& grab) {
  Real mass = body.mass;
  if (body.kind == BodyKind::liquid) {
    mass = 0;
    for (const Index i : grab.held) mass += model.mass[body.particles.begin + i];
  }
  grab.stiffness = mass * kGrabFrequency * kGrabFrequency;
  grab.damping = 2 * mass * kGrabFrequency;
  grab.max_force = mass * kGrabMaxAcceleration;
}

}  // namespace

Status Simulation::grab_start(std::uint64_t id, BodyId body_id, Index particle,
                              const Vec3& target) {
  const ModelBody* body = impl_->find(body_id);
  if (body == nullptr) return no_such_body();
  if (particle >= body->particles.size()) {
    return Error{"out_of_range", "/particle",
                 "must be below " + std::to_string(body->particles.size())};
  }
  if (Status status = check_vector(target, kMaxLength, "/target"); !status) return status;
  std::vector<Grab>& grabs = impl_->controls.grabs;
  std::erase_if(grabs, [&](const Grab& grab) { return grab.id == id; });
  if (grabs.size() >= kMaxGrabs) {
    return Error{"limit_reached", "", "at most " + std::to_string(kMaxGrabs) + " grabs at once"};
  }
  Grab grab;
  grab.id = id;
  grab.body_id = body_id;
  grab.body = static_cast<Index>(body - impl_->model->bodies.data());
  grab.particle = particle;
  grab.held = held_particles(*impl_->model, *body, impl_->state.now, particle);
  grab.target = target;
  tune_grab(*impl_->model, *body, grab);
  grabs.push_back(std::move(grab));
  impl_->state.forces_current = false;
  return {};
}

namespace {

Error no_such_grab() {
  return {"no_such_grab", "/grab", "there is no grab with this id"};
}

}  // namespace

Status Simulation::grab_move(std::uint64_t id, const Vec3& target) {
  const auto grab = std::ranges::find(impl_->controls.grabs, id, &Grab::id);
  if (grab == impl_->controls.grabs.end()) return no_such_grab();
  if (Status status = check_vector(target, kMaxLength, "/target"); !status) return status;
  grab->target = target;
  impl_->state.forces_current = false;
  return {};
}

Status Simulation::grab_end(std::uint64_t id) {
  if (std::erase_if(impl_->controls.grabs, [&](const Grab& g) { return g.id == id; }) == 0) {
    return no_such_grab();
  }
  impl_->state.forces_current = false;
  return {};
}

}  // namespace vat
