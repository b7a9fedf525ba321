#include "core/state/state.h"

#include <algorithm>

#include "core/state/body_state.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

template <class T>
void copy_column(const std::vector<T>& from, TaskRunner* runner, std::vector<T>& to) {
  to.resize(from.size());
  for_blocks(runner, from.size(), [&](std::size_t begin, std::size_t end) {
    std::copy(from.data() + begin, from.data() + end, to.data() + begin);
  });
}

}  // namespace

void copy(const Configuration& from, TaskRunner* runner, Configuration& to) {
  copy_column(from.position, runner, to.position);
  copy_column(from.velocity, runner, to.velocity);
  to.rigid = from.rigid;
  to.contacts = from.contacts;
  copy_column(from.springs, runner, to.springs);
  copy_column(from.pressure, runner, to.pressure);
}

void place_body(const Model& model, const ModelBody& body, Configuration& configuration) {
  const SampledBody& sample = *body.sample;
  VAT_CHECK(sample.positions.size() == body.particles.size() &&
            body.particles.end <= configuration.position.size());
  std::ranges::copy(sample.positions, configuration.position.begin() + body.particles.begin);
  std::ranges::copy(sample.velocities, configuration.velocity.begin() + body.particles.begin);
  for (const Index fixed : sample.fixed) {
    configuration.velocity[body.particles.begin + fixed].setZero();
  }
  if (body.kind != BodyKind::rigid) return;

  const RigidModel& rigid = model.rigid_bodies[body.rigid];
  RigidState& state = configuration.rigid[body.rigid];
  const BodyDescription& description = model.scene.bodies[rigid.body];
  state = {Vec3::Zero(), description.orientation.normalized(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < sample.positions.size(); ++i) {
    state.center_of_mass += sample.masses[i] * sample.positions[i];
    state.momentum += sample.masses[i] * sample.velocities[i];
  }
  state.center_of_mass *= rigid.axle ? 1 / rigid.mass : rigid.inverse_mass;
  // From the given angular velocity and I, not from the motion of the particles, which does not
  // include the spin of each particle as a sphere.
  state.angular_momentum =
      angular_momentum_of(rigid, state.orientation, description.angular_velocity);
  pose_rigid_body(model, rigid, state, configuration);
}

State initial_state(const Model& model) {
  State state;
  state.now.position.resize(model.particle_count);
  state.now.velocity.resize(model.particle_count);
  state.now.rigid.resize(model.rigid_bodies.size());
  if (model.is_incompressible) state.now.pressure.assign(model.liquid_count, 0);
  for (const ModelBody& body : model.bodies) place_body(model, body, state.now);
  if (model.springs_change) {
    for (const SpringEnd& spring : model.spring_ends) {
      state.now.springs.push_back({spring.rest_length, false});
    }
  }
  if (model.scene.sleeping) state.slow_looks.assign(model.bodies.size(), 0);
  state.forces = no_forces(model);
  return state;
}

}  // namespace vat
