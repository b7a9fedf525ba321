#include "core/liquid/pairs/no_slip.h"

#include "core/laws/vat_motion.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/support/check.h"

namespace vat {
void fill_liquid_density(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Vat& vat = *c.model.scene.vat;
  const VatMotion motion = vat_motion(vat, c.time);
  VAT_CHECK(buffers.density.size() == c.model.liquid_count);
  buffers.filled_density.resize(c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, i);
      Real filling = 0;
      for (const int wall : c.model.no_slip_walls) {
        const Real d = wall_distance(vat, motion, wall, c.configuration.position[i]);
        filling += liquid.half_space.filling(d);
      }
      buffers.filled_density[i] = buffers.density[i] + liquid.rest_density * filling;
    }
  });
}

Real no_slip_drag(const Model& model, const Scratch& work, Index i, Real d) {
  const LiquidModel& liquid = liquid_of(model, i);
  const Real volume = model.mass[i] / work.of<LiquidScratch>().filled_density[i];
  return liquid.viscosity * volume * liquid.half_space.drag(d);
}

// The velocity of the liquid beyond the wall is v(s) = v_i - (v_i - v_wall) s/d at the distance s
// from the particle along the wall's normal, so that it is the wall's velocity at s = d. The sum is
// that of other viscous forces, with an integral in place of the sum over V_j: F_i = -mu V_i (v_i -
// v_wall) * integral of s/d laplacian W, along the wall only. The spring of the wall keeps liquid
// from passing through.
void add_no_slip_forces(StepContext& c) {
  const Vat& vat = *c.model.scene.vat;
  const VatMotion motion = vat_motion(vat, c.time);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const int wall : c.model.no_slip_walls) {
        const Real d = wall_distance(vat, motion, wall, c.configuration.position[i]);
        const Real drag = no_slip_drag(c.model, c.work, static_cast<Index>(i), d);
        const Vec3 wall_velocity =
            motion.velocity + vat.walls[static_cast<std::size_t>(wall)].velocity;
        Vec3 slip = c.configuration.velocity[i] - wall_velocity;
        slip[wall / 2] = 0;
        c.forces.particle[i] -= drag * slip;
      }
    }
  });
}

}  // namespace vat
