#include "core/external/external.h"

#include <algorithm>

#include "core/contact/scratch.h"
#include "core/laws/vat_motion.h"
#include "core/model/acting_forces.h"
#include "core/stage/context.h"
#include "core/state/controls.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {
namespace {

void add_applied_force(const AppliedForce& applied, StepContext& c) {
  if (c.step >= applied.end_step) return;
  VAT_CHECK(applied.body < c.model.bodies.size());
  const IndexRange particles = c.model.bodies[applied.body].particles;
  for (Index i = particles.begin; i < particles.end; ++i) {
    c.forces.particle[i] += c.model.mass[i] * applied.acceleration;
  }
}

void add_grab(const Grab& grab, StepContext& c) {
  const Index first = c.model.bodies[grab.body].particles.begin;
  VAT_CHECK(grab.particle < c.model.bodies[grab.body].particles.size() && grab.held_mass > 0);
  const Index held = first + grab.particle;
  const PeriodicBox& box = c.model.periodic;
  const Vec3 way = box.nearest(box.wrap(grab.target) - box.wrap(c.configuration.position[held]));
  Vec3 force = grab.stiffness * way - grab.damping * c.configuration.velocity[held];
  const Real size = force.norm();
  if (size > grab.max_force) force *= grab.max_force / size;
  if (c.model.scene.dimensions == 2) force.y() = 0;  // the target may be outside the plane
  for (const Index i : grab.held) {
    c.forces.particle[first + i] += (c.model.mass[first + i] / grab.held_mass) * force;
  }
}

/// a = -Omega^2 (x - center).
void add_central_field(const CentralField& field, StepContext& c) {
  const Real strength = field.angular_frequency * field.angular_frequency;
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 arm = c.configuration.position[i] - field.center;
      c.forces.particle[i] -= (c.model.mass[i] * strength) * arm;
    }
  });
}

void add_settling_drag(const Settling& settling, StepContext& c) {
  if (c.time >= settling.until) return;
  const Scene& scene = c.model.scene;
  const Vec3 still = scene.vat ? vat_motion(*scene.vat, c.time).velocity : Vec3(Vec3::Zero());
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 slip = c.configuration.velocity[i] - still;
      c.forces.particle[i] -= (c.model.mass[i] * settling.drag) * slip;
    }
  });
}

}  // namespace

void set_external_forces(StepContext& c) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  const Scene& scene = c.model.scene;
  const Vec3 gravity = scene.forces.gravity ? scene.gravity : Vec3(Vec3::Zero());
  const bool has_loads = has_contact_forces(c.model) || has_wall_forces(c.model);
  contact_buffers.contact_loads.resize(has_loads ? c.model.particle_count : 0);
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) c.forces.particle[i] = c.model.mass[i] * gravity;
    if (has_loads)
      std::fill_n(contact_buffers.contact_loads.data() + begin, end - begin, ContactLoad{});
  });
  if (c.model.has_friction) c.forces.friction_torque.assign(c.model.particle_count, Vec3::Zero());
  if (scene.forces.gravity && scene.central_field) add_central_field(*scene.central_field, c);
  if (scene.settling) add_settling_drag(*scene.settling, c);
  for (const AppliedForce& applied : c.controls.applied_forces) add_applied_force(applied, c);
  for (const Grab& grab : c.controls.grabs) add_grab(grab, c);
}

}  // namespace vat
