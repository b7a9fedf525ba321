#include "core/damping/liquid_drags.h"

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/tait/weakly_compressible.h"
#include "core/model/acting_forces.h"
#include "core/support/check.h"

namespace vat {

void add_liquid_drags(const StepContext& c, const std::vector<Vec3>& w, std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  VAT_CHECK(w.size() == model.particle_count && force.size() == model.particle_count);
  const std::span<const Index> order = buffers.liquid.grid.order();
  const std::span<const Index> solids = buffers.solids_in_liquid.grid.order();
  const bool images_drag = is_dragged_by_all_images(model);
  const ImageVelocities velocity_of =
      images_drag ? ImageVelocities(*model.scene.vat, {}, false) : ImageVelocities();
  const auto motion_of_image = [&](const PairImage& image, const PairMotion& source) {
    const Vec3 velocity(source.vx, source.vy, source.vz);
    const bool is_mirrored = images_drag && image.walls > 0;
    return motion_of(0, is_mirrored ? velocity_of(image, velocity) : image.turn(velocity));
  };
  buffers.sources.set_motions(
      c.runner, [&](std::size_t s) { return motion_of(0, w[order[s]]); },
      [&](std::size_t s) { return motion_of(0, w[model.liquid_count + solids[s]]); },
      motion_of_image);
  if (has_solids(model)) buffers.sources.set_weights(c, {});
  add_pair_forces(c, pair_sums_of(c).force, force);
  if (has_solids(model)) add_pair_forces_on_solids(c, pair_sums_of(c).force, force);
  if (has_viscous_images(model) && !images_drag) add_viscous_image_forces(c, w, false, force);
}

}  // namespace vat
