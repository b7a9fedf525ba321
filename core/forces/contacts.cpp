#include "core/forces/contacts.h"

#include "core/forces/connection.h"
#include "core/forces/contact_search.h"
#include "core/forces/pair_direction.h"

namespace vat {

void sort_solids(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  c.work.solids.build(points.subspan(c.model.liquid_count), c.model.contact_reach,
                      c.model.periodic);
}

void add_contacts(StepContext& c) {
  const Configuration& at = c.configuration;
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum = Vec3::Zero();
      for_each_contact(c.model, c.work, at, static_cast<Index>(i), [&](const Contact& contact) {
        const Vec3 n = pair_direction(contact.x, contact.distance, contact.self, contact.other,
                                      c.model.scene.dimensions);
        const Real speed = (at.velocity[i] - at.velocity[contact.other]).dot(n);
        const Real push = connection_push(contact.stiffness, contact.damping, contact.threshold,
                                          contact.distance, speed);
        if (push > 0) sum += push * n;
      });
      c.forces.particle[i] += sum;
    }
  });
}

}  // namespace vat
