#include "core/state/kick_drift.h"

#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Moves the particles from `first` to `last`, without `last`.
void drift_particles(TaskRunner* runner, Configuration& configuration, Index first, Index last,
                     Real dt) {
  VAT_CHECK(first <= last && last <= configuration.position.size() &&
            configuration.velocity.size() == configuration.position.size());
  for_blocks(runner, last - first, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = first + begin; i < first + end; ++i) {
      configuration.position[i] += dt * configuration.velocity[i];
    }
  });
}

void drift_rigid_bodies(const Model& model, Configuration& configuration, Real dt) {
  VAT_CHECK(configuration.rigid.size() == model.rigid_bodies.size());
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    RigidState& state = configuration.rigid[b];
    state.center_of_mass += (dt * rigid.inverse_mass) * state.momentum;
    // A held body at rest remains bitwise equal.
    if (rigid.free_from > 0 && state.angular_momentum.isZero(0)) continue;
    state.orientation = rotate_freely(rigid, state.orientation, state.angular_momentum, dt);
  }
}

}  // namespace

void drift(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt) {
  drift_particles(runner, configuration, 0, model.free_count, dt);
  drift_rigid_bodies(model, configuration, dt);
}

void drift_liquids(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt) {
  drift_particles(runner, configuration, 0, model.liquid_count, dt);
}

void drift_solids(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt) {
  drift_particles(runner, configuration, model.liquid_count, model.free_count, dt);
  drift_rigid_bodies(model, configuration, dt);
}

void move_with_transport(const Model& model, TaskRunner* runner, const Forces& forces,
                         Configuration& configuration, Real dt) {
  VAT_CHECK(forces.transport.size() <= model.liquid_count);
  for_blocks(runner, forces.transport.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (model.inverse_mass[i] > 0) configuration.position[i] += dt * forces.transport[i];
    }
  });
}

void kick(const Model& model, TaskRunner* runner, const Forces& forces,
          Configuration& configuration, Real dt) {
  VAT_CHECK(forces.particle.size() == model.particle_count &&
            configuration.velocity.size() == model.particle_count);
  VAT_CHECK(forces.rigid_force.size() == model.rigid_bodies.size() &&
            configuration.rigid.size() == model.rigid_bodies.size());
  for_blocks(runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      configuration.velocity[i] += (dt * model.inverse_mass[i]) * forces.particle[i];
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    configuration.rigid[b].momentum += dt * forces.rigid_force[b];
    configuration.rigid[b].angular_momentum += dt * forces.rigid_torque[b];
  }
}

}  // namespace vat
