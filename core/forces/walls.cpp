#include "core/forces/walls.h"

#include <algorithm>

#include "core/forces/connection.h"
#include "core/step/workspace.h"

namespace vat {
Vec3 wall_force(const Model& model, const VatMotion& motion, const Configuration& at, Index i) {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  const Real threshold = law.threshold > 0 ? law.threshold : model.radius[i];
  Vec3 force = Vec3::Zero();
  for (const int wall : model.walls) {
    const Real distance = wall_distance(*model.scene.vat, motion, wall, at.position[i]);
    if (distance >= threshold) continue;
    const int axis = wall / 2;
    const Real side = wall % 2 == 0 ? 1 : -1;
    const Real speed = side * (at.velocity[i][axis] - motion.velocity[axis]);
    force[axis] += side * std::max(Real{0}, connection_push(law.stiffness, law.damping, threshold,
                                                            distance, speed));
  }
  return force;
}

void add_wall_forces(StepContext& c) {
  const VatMotion motion = vat_motion(*c.model.scene.vat, c.time);
  c.work.contact_loads.resize(c.model.particle_count);
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 force = wall_force(c.model, motion, c.configuration, static_cast<Index>(i));
      if (force.isZero(0)) continue;
      c.forces.particle[i] += force;
      const ContactLaw& law = c.model.wall_laws[c.model.material[i]];
      c.work.contact_loads[i].stiffness += law.stiffness;
      c.work.contact_loads[i].damping += law.damping;
    }
  });
}

}  // namespace vat
