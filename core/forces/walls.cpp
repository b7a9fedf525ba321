#include "core/forces/walls.h"

#include <algorithm>

#include "core/forces/vat_motion.h"
#include "core/step/workspace.h"

namespace vat {
namespace {

Vec3 wall_force(const Model& model, const VatMotion& motion, const ContactLaw& law, Real threshold,
                const Vec3& position, const Vec3& velocity) {
  Vec3 force = Vec3::Zero();
  for (const int wall : model.walls) {
    const Real overlap = threshold - wall_distance(*model.scene.vat, motion, wall, position);
    if (overlap <= 0) continue;
    const int axis = wall / 2;
    const Real side = wall % 2 == 0 ? 1 : -1;
    const Real speed = side * (velocity[axis] - motion.velocity[axis]);
    force[axis] += side * std::max(Real{0}, law.stiffness * overlap - law.damping * speed);
  }
  return force;
}

}  // namespace

void add_wall_forces(StepContext& c) {
  const VatMotion motion = vat_motion(*c.model.scene.vat, c.time);
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ContactLaw& law = c.model.wall_laws[c.model.material[i]];
      const Real threshold = law.threshold > 0 ? law.threshold : c.model.radius[i];
      c.forces.particle[i] += wall_force(c.model, motion, law, threshold,
                                         c.configuration.position[i], c.configuration.velocity[i]);
    }
  });
}

}  // namespace vat
