#include "core/contact/restitution.h"

#include <algorithm>

#include "core/contact/scratch.h"
#include "core/laws/contact_damping.h"
#include "core/laws/pair_direction.h"
#include "core/laws/vat_motion.h"
#include "core/stage/context.h"
#include "core/state/rigid_motion.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {

namespace {

Vec3 sum_directions(const StepContext& c, const VatMotion& motion, Index i) {
  const Model& model = c.model;
  Vec3 sum = Vec3::Zero();
  if (model.contact_reach > 0) {
    c.work.of<ContactForceScratch>().contacts.for_each(
        model, c.configuration, i, [&](const Contact& contact) {
          if (contact.stiffness == 0) return;
          sum +=
              pair_direction(contact.x, contact.distance, i, contact.other, model.scene.dimensions);
        });
  }
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (model.walls.empty() || law.stiffness == 0) return sum;
  const Real threshold = law.wall_threshold(model.radius[i]);
  for (const int wall : model.walls) {
    const Vec3& position = c.configuration.position[i];
    if (wall_distance(*model.scene.vat, motion, wall, position) < threshold) {
      sum += wall_normal(wall);
    }
  }
  return sum;
}

void spread_over_body(StepContext& c, std::size_t body) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  const RigidModel& rigid = c.model.rigid_bodies[body];
  const RigidState& state = c.configuration.rigid[body];
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    force += contact_buffers.mobilities[i];
    torque +=
        (c.configuration.position[i] - state.center_of_mass).cross(contact_buffers.mobilities[i]);
  }
  const Vec3 linear = rigid.inverse_mass * force;
  const Vec3 angular = angular_velocity(rigid, state.orientation, torque);
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    contact_buffers.mobilities[i] =
        linear + angular.cross(c.configuration.position[i] - state.center_of_mass);
  }
}

}  // namespace

void find_contact_mobilities(StepContext& c) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  VAT_CHECK(c.configuration.position.size() == c.model.particle_count);
  const Model& model = c.model;
  const VatMotion motion = model.walls.empty() ? VatMotion{} : vat_motion(*model.scene.vat, c.time);
  contact_buffers.mobilities.resize(model.particle_count);
  for_blocks(c.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      const Vec3 sum = sum_directions(c, motion, i);
      contact_buffers.mobilities[i] =
          i < model.free_count ? Vec3(model.inverse_mass[i] * sum) : sum;
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const IndexRange particles = model.rigid_bodies[b].particles;
    if (model.rigid_bodies[b].is_held(c.step)) {
      std::fill_n(contact_buffers.mobilities.begin() + particles.begin, particles.size(),
                  Vec3::Zero());
    } else {
      spread_over_body(c, b);
    }
  }
}

Real ContactMobility::along(Index i, const Vec3& normal) const {
  VAT_CHECK(i < work.of<ContactForceScratch>().mobilities.size());
  const Real shared = normal.dot(work.of<ContactForceScratch>().mobilities[i]);
  if (i < model.free_count) return std::max(shared, model.inverse_mass[i]);
  const Index body = model.bodies[model.body[i]].rigid;
  const RigidModel& rigid = model.rigid_bodies[body];
  if (rigid.is_held(step)) return 0;
  const RigidState& state = at.rigid[body];
  const Vec3 lever = (at.position[i] - state.center_of_mass).cross(normal);
  const Real own =
      rigid.inverse_mass + lever.dot(angular_velocity(rigid, state.orientation, lever));
  return std::max(shared, own);
}

Real ContactMobility::wall_damping(Index i, const Vec3& normal) const {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (law.damping_ratio == 0) return law.damping;
  return damping_for(law.damping_ratio, law.stiffness, along(i, normal));
}

}  // namespace vat
