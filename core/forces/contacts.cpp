#include "core/forces/contacts.h"

#include <algorithm>

#include "core/forces/connection.h"
#include "core/forces/dampers.h"
#include "core/forces/pair_direction.h"
#include "core/model/model.h"
#include "core/step/workspace.h"

namespace vat {

void sort_solids(StepContext& c, Real slack) {
  const std::span<const Vec3> points(c.configuration.position);
  c.work.solids.build(points.subspan(c.model.liquid_count), c.model.contact_reach + slack,
                      c.model.periodic);
}

void find_contacts(StepContext& c) {
  c.work.contacts.update(c, 0);
}

namespace {

template <bool keep_dampers, bool has_friction>
void add_block(StepContext& c, std::size_t begin, std::size_t end) {
  const Configuration& at = c.configuration;
  DamperBlock* const kept = keep_dampers ? &c.work.contact_dampers[begin / kBlockSize] : nullptr;
  if constexpr (keep_dampers) kept->dampers.clear();
  for (std::size_t i = begin; i < end; ++i) {
    Vec3 sum = Vec3::Zero();
    ContactLoad load;
    if constexpr (keep_dampers) kept->begin[i - begin] = static_cast<Index>(kept->dampers.size());
    c.work.contacts.for_each(c.model, at, static_cast<Index>(i), [&](const Contact& contact) {
      const Vec3 n = pair_direction(contact.x, contact.distance, contact.self, contact.other,
                                    c.model.scene.dimensions);
      const Vec3 velocity = at.velocity[i] - at.velocity[contact.other];
      const Real speed = velocity.dot(n);
      const Real push = connection_push(contact.stiffness, contact.damping, contact.threshold,
                                        contact.distance, speed);
      if (push <= 0) return;
      sum += push * n;
      load.stiffness += 2 * contact.stiffness;
      Real damping = contact.damping;
      if constexpr (keep_dampers) kept->dampers.push_back({contact.other, contact.damping, n});
      if constexpr (has_friction) {
        const Friction friction =
            pair_friction(c.model, contact.self, contact.other, contact.stiffness);
        if (friction.acts()) {
          const Vec3 slip = slip_velocity(velocity, speed, n);
          const Real drag = friction.drag(push, slip);
          sum -= drag * slip;
          damping = std::max(damping, friction.sticking);
          if constexpr (keep_dampers) add_drag(drag, contact.other, n, kept->dampers);
        }
      }
      load.damping += 2 * damping;
    });
    c.forces.particle[i] += sum;
    c.work.contact_loads[i] = load;
  }
  if constexpr (keep_dampers) kept->begin[end - begin] = static_cast<Index>(kept->dampers.size());
}

}  // namespace

void add_contacts(StepContext& c) {
  c.work.contact_loads.resize(c.model.particle_count);
  if (c.work.keep_dampers) {
    c.work.contact_dampers.resize((c.model.particle_count + kBlockSize - 1) / kBlockSize);
  }
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    if (c.model.has_friction) {
      c.work.keep_dampers ? add_block<true, true>(c, begin, end)
                          : add_block<false, true>(c, begin, end);
    } else {
      c.work.keep_dampers ? add_block<true, false>(c, begin, end)
                          : add_block<false, false>(c, begin, end);
    }
  });
}

}  // namespace vat
