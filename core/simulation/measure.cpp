#include "core/simulation/measure.h"
#include "core/contact/scratch.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>

#include "core/external/external.h"
#include "core/laws/lennard_jones.h"
#include "core/laws/vat_motion.h"
#include "core/liquid/gas/liquid.h"
#include "core/rigid/guided_bodies.h"
#include "core/solid/spring_changes.h"
#include "core/solid/volume.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

BodyDiagnostics measure_free_body(const Model& model, const ModelBody& body,
                                  const Configuration& at) {
  BodyDiagnostics result{body.id,      body.name,    body.mass,    Vec3::Zero(), Vec3::Zero(),
                         Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), {},           {}};
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    const Vec3 momentum = model.mass[i] * at.velocity[i];
    result.center_of_mass += (model.mass[i] / body.mass) * at.position[i];
    result.linear_momentum += momentum;
    result.angular_momentum += at.position[i].cross(momentum);
  }
  return result;
}

BodyDiagnostics measure_rigid_body(const Model& model, const ModelBody& body,
                                   const Configuration& at) {
  const RigidState& state = at.rigid[body.rigid];
  return {
      body.id,
      body.name,
      body.mass,
      state.center_of_mass,
      state.momentum,
      state.angular_momentum + state.center_of_mass.cross(state.momentum),
      Vec3::Zero(),
      Vec3::Zero(),
      state.orientation,
      angular_velocity(model.rigid_bodies[body.rigid], state.orientation, state.angular_momentum)};
}

Real kinetic_energy(const Model& model, const Configuration& at) {
  Real energy = 0;
  for (Index i = 0; i < model.free_count; ++i) {
    energy += 0.5 * model.mass[i] * at.velocity[i].squaredNorm();
  }
  for (std::size_t b = 0; b < at.rigid.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    const RigidState& state = at.rigid[b];
    const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
    energy += 0.5 * rigid.inverse_mass * state.momentum.squaredNorm() +
              0.5 * omega.dot(state.angular_momentum);
  }
  return energy;
}

Real elastic_energy(const Model& model, const Configuration& at) {
  Real energy = 0;
  for (Index i = model.liquid_count; i < model.free_count; ++i) {
    for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
      const SpringEnd spring = present_spring(model, at, s);
      const Real stretch = (at.position[i] - at.position[spring.other]).norm() - spring.rest_length;
      energy += 0.25 * spring.stiffness * stretch * stretch;  // each spring has two ends
    }
  }
  return energy;
}

Real pair_contact_energy(const Model& model, const Scratch& work, const Configuration& at) {
  Real energy = 0;
  for (Index i = 0; i < model.particle_count; ++i) {
    work.of<ContactForceScratch>().contacts.for_each(model, at, i, [&](const Contact& contact) {
      if (contact.layer > 0) {  // each contact is visited twice
        energy += 0.5 * layer_energy(contact.stiffness, contact.layer, contact.threshold,
                                     contact.distance);
        return;
      }
      const Real overlap = contact.threshold - contact.distance;
      energy += 0.25 * contact.stiffness * overlap * overlap;
    });
  }
  return energy;
}

Real wall_contact_energy(const Model& model, const Configuration& at, Real time) {
  const Vat& vat = *model.scene.vat;
  const VatMotion motion = vat_motion(vat, time);
  Real energy = 0;
  for (Index i = 0; i < model.particle_count; ++i) {
    const ContactLaw& law = model.wall_laws[model.material[i]];
    const Real threshold = law.wall_threshold(model.radius[i]);
    const Real layer = threshold * law.layer / (1 + law.layer);
    for (const int wall : model.walls) {
      const Real distance = wall_distance(vat, motion, wall, at.position[i]);
      const Real overlap = threshold - distance;
      if (overlap <= 0) continue;
      energy += layer > 0 ? layer_energy(law.stiffness, layer, threshold, distance)
                          : 0.5 * law.stiffness * overlap * overlap;
    }
  }
  return energy;
}

std::size_t count_outside(const Model& model, const Configuration& at, Real time) {
  const Vat& vat = *model.scene.vat;
  const VatMotion motion = vat_motion(vat, time);
  std::size_t count = 0;
  for (const Vec3& position : at.position) {
    bool outside = false;
    for (const int wall : model.walls) {
      outside = outside || !(wall_distance(vat, motion, wall, position) >= 0);
    }
    count += outside ? 1 : 0;
  }
  return count;
}

void measure_density_error(const Model& model, const Scratch& work, Diagnostics& result) {
  Real sum = 0;
  for (Index i = 0; i < model.liquid_count; ++i) {
    const Real rest_density = model.liquids[model.material[i]]->rest_density;
    const Real error = std::max(Real{0}, work.of<LiquidScratch>().density[i] / rest_density - 1);
    sum += error;
    result.max_density_error = std::max(result.max_density_error, error);
  }
  if (model.liquid_count > 0) result.mean_density_error = sum / model.liquid_count;
}

bool runs(const StepPlan& plan, StageFunction stage) {
  return std::ranges::find(plan.stages, stage, &Stage::run) != plan.stages.end();
}

/// Computes density and pressure if no force needs them.
void complete_liquid_fields(StepContext& c) {
  if (c.model.liquid_count == 0 || c.model.is_coupled) return;
  if (!runs(c.model.plan, &compute_liquid_density)) {
    sort_liquid(c);
    compute_liquid_density(c);
  }
  if (!runs(c.model.plan, &compute_liquid_pressure)) compute_liquid_pressure(c);
}

/// Forces between the particles of the body cancel in the sums.
void measure_outer_forces(const ModelBody& body, const Configuration& at, const Forces& inner,
                          BodyDiagnostics& result) {
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    result.outer_force += inner.particle[i];
    result.outer_torque += (at.position[i] - result.center_of_mass).cross(inner.particle[i]);
    if (!inner.friction_torque.empty()) result.outer_torque += inner.friction_torque[i];
  }
}

Real external_energy(const Model& model, const Configuration& at) {
  const Scene& scene = model.scene;
  if (!scene.forces.gravity) return 0;
  Real energy = 0;
  for (Index i = 0; i < model.particle_count; ++i) {
    energy -= model.mass[i] * scene.gravity.dot(at.position[i]);
  }
  if (!scene.central_field) return energy;
  const auto& [center, omega] = *scene.central_field;
  for (Index i = 0; i < model.particle_count; ++i) {
    energy += 0.5 * model.mass[i] * omega * omega * (at.position[i] - center).squaredNorm();
  }
  return energy;
}

}  // namespace

StepContext evaluate_inner_forces(const ForceModel& force_model, Configuration& at, Real time,
                                  Forces& forces) {
  const Model& model = force_model.model;
  forces.particle.assign(model.particle_count, Vec3::Zero());
  forces.rigid_force.resize(model.rigid_bodies.size());
  forces.rigid_torque.resize(model.rigid_bodies.size());
  if (model.has_friction) forces.friction_torque.assign(model.particle_count, Vec3::Zero());
  StepContext context{model,
                      force_model.controls,
                      time,
                      force_model.step,
                      at,
                      forces,
                      force_model.work,
                      force_model.runner};
  for (const Stage& stage : model.plan.stages) {
    if (stage.run != &set_external_forces) stage.run(context);
  }
  return context;
}

Diagnostics measure(const ForceModel& force_model, Configuration at, Real time) {
  const Model& model = force_model.model;
  VAT_CHECK(at.position.size() == force_model.model.particle_count);
  Forces forces;
  StepContext context = evaluate_inner_forces(force_model, at, time, forces);
  complete_liquid_fields(context);

  Diagnostics result{};
  result.time = time;
  for (const ModelBody& body : model.bodies) {
    result.bodies.push_back(body.kind == BodyKind::rigid ? measure_rigid_body(model, body, at)
                                                         : measure_free_body(model, body, at));
    measure_outer_forces(body, at, forces, result.bodies.back());
    if (body.kind != BodyKind::rigid || !model.rigid_bodies[body.rigid].axle) continue;
    result.axle_torque =
        result.axle_torque.value_or(0) +
        torque_on_axle(model.rigid_bodies[body.rigid], result.bodies.back().outer_torque);
  }
  result.kinetic_energy = kinetic_energy(model, at);
  result.gravitational_energy = external_energy(model, at);
  result.elastic_energy = elastic_energy(model, at) + cell_energy(model, at);
  result.torn_springs = count_torn(at);
  if (model.contact_reach > 0) {
    result.contact_energy = pair_contact_energy(model, force_model.work, at);
  }
  if (model.scene.vat) {
    result.contact_energy += wall_contact_energy(model, at, time);
    result.particles_outside = count_outside(model, at, time);
  }
  measure_density_error(model, force_model.work, result);
  return result;
}

}  // namespace vat
