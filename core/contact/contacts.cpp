#include "core/contact/contacts.h"

#include <algorithm>

#include "core/contact/restitution.h"
#include "core/contact/scratch.h"
#include "core/laws/connection.h"
#include "core/laws/contact_damping.h"
#include "core/laws/lennard_jones.h"
#include "core/laws/pair_direction.h"
#include "core/model/model.h"
#include "core/stage/context.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {

void find_contacts(StepContext& c) {
  c.work.of<ContactForceScratch>().contacts.update(c, 0);
}

namespace {

/// The terms of a scene's contacts. A loop contains only these.
struct ContactTerms {
  bool keep_dampers = false;
  bool friction = false;
  bool restitution = false;
  bool layers = false;
};

/// The sum over the contacts of one particle.
struct ContactSum {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< of friction, about the particle's centre [N m]
  ContactLoad load;
};

void add_layer(const Contact& contact, const Vec3& normal, ContactSum& sum) {
  sum.force +=
      layer_push(contact.stiffness, contact.layer, contact.threshold, contact.distance) * normal;
  sum.load.stiffness += 2 * greatest_layer_slope(contact.stiffness, contact.layer,
                                                 contact.threshold, contact.distance);
}

/// Adds a spring with a dashpot, and friction if there is any.
template <ContactTerms terms>
void add_spring(const StepContext& c, const Contact& contact, const Vec3& n, ContactSum& sum,
                DamperBlock* kept) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  const Configuration& at = c.configuration;
  const Vec3 velocity = at.velocity[contact.self] - at.velocity[contact.other];
  const Real speed = velocity.dot(n);
  Real damping = contact.damping;
  if constexpr (terms.restitution) {
    if (contact.damping_ratio > 0) {
      const ContactMobility mobilities{c.model, c.work, at, c.step};
      damping =
          damping_for(contact.damping_ratio, contact.stiffness,
                      mobilities.along(contact.self, n) + mobilities.along(contact.other, -n));
    }
  }
  const Real push =
      connection_push(contact.stiffness, damping, contact.threshold, contact.distance, speed);
  if (push <= 0) return;
  sum.force += push * n;
  sum.load.stiffness += 2 * contact.stiffness;
  if constexpr (terms.keep_dampers) {
    if (damping > 0) kept->dampers.push_back({contact.other, damping, n});
  }
  if constexpr (terms.friction) {
    const Friction friction =
        pair_friction(c.model, contact.self, contact.other, contact.stiffness);
    if (friction.acts()) {
      const ContactArms arms =
          pair_arms(c.model, contact.self, contact.other, contact.distance * n);
      const Vec3 slip = slip_velocity(velocity, speed, n) +
                        turning_velocity(c.model, contact_buffers.spins, contact.self, arms.self) -
                        turning_velocity(c.model, contact_buffers.spins, contact.other, arms.other);
      const Real drag = friction.drag(push, slip);
      sum.force -= drag * slip;
      sum.torque -= drag * arms.self.cross(slip);
      damping = std::max(damping, friction.sticking);
      if constexpr (terms.keep_dampers) {
        kept->friction_dampers.push_back({contact.other, drag, n, arms.self, arms.other});
      }
    }
  }
  sum.load.damping += 2 * damping;
}

template <ContactTerms terms>
void add_block(StepContext& c, std::size_t block) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  DamperBlock* const kept = terms.keep_dampers ? &contact_buffers.contact_dampers[block] : nullptr;
  if constexpr (terms.keep_dampers) kept->clear();
  for (const Index i : contact_buffers.contacts.particles(block)) {
    ContactSum sum;
    contact_buffers.contacts.for_each(c.model, c.configuration, i, [&](const Contact& contact) {
      const Vec3 n = pair_direction(contact.x, contact.distance, contact.self, contact.other,
                                    c.model.scene.dimensions);
      if constexpr (terms.layers) {
        if (contact.layer > 0) return add_layer(contact, n, sum);
      }
      add_spring<terms>(c, contact, n, sum, kept);
    });
    c.forces.particle[i] += sum.force;
    if constexpr (terms.friction) c.forces.friction_torque[i] += sum.torque;
    contact_buffers.contact_loads[i] = sum.load;  // contacts set the load, walls add to it
    if constexpr (terms.keep_dampers) kept->close(i);
  }
}

template <bool keep_dampers>
void add_terms(StepContext& c, std::size_t block) {
  const Model& model = c.model;
  if (model.has_restitution || model.has_layers) {
    model.has_friction ? add_block<ContactTerms{keep_dampers, true, true, true}>(c, block)
                       : add_block<ContactTerms{keep_dampers, false, true, true}>(c, block);
  } else {
    model.has_friction ? add_block<ContactTerms{keep_dampers, true, false, false}>(c, block)
                       : add_block<ContactTerms{keep_dampers, false, false, false}>(c, block);
  }
}

}  // namespace

void add_contacts(StepContext& c) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  contact_buffers.contact_loads.resize(c.model.particle_count);
  if (c.work.keep_dampers) {
    contact_buffers.contact_dampers.resize(block_count(c.model.particle_count));
  }
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t) {
    const std::size_t block = begin / kBlockSize;
    c.work.keep_dampers ? add_terms<true>(c, block) : add_terms<false>(c, block);
  });
}

}  // namespace vat
