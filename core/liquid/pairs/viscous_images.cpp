#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/pairs/scratch.h"

#include "core/model/acting_forces.h"

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"

namespace vat {

ImageVelocities::ImageVelocities(const Vat& vat, const VatMotion& motion, bool walls_move) {
  for (std::size_t index = 0; index < all_.size(); ++index) {
    all_[index] = velocity_of(vat, motion, walls_move, index);
  }
}

/// One wall after the other, each in its own frame. A slip wall keeps the velocity along it.
ImageVelocities::MirroredVelocity ImageVelocities::velocity_of(const Vat& vat,
                                                               const VatMotion& motion,
                                                               bool walls_move, std::size_t index) {
  MirroredVelocity result;
  for (int axis = 0; axis < 3; ++axis, index /= 3) {
    if (index % 3 == 0) continue;
    const Wall& wall = vat.walls[2 * static_cast<std::size_t>(axis) + index % 3 - 1];
    Vec3 factor = Vec3::Constant(wall.no_slip ? -1 : 1);
    factor[axis] = -1;
    const Vec3 of_wall = walls_move ? Vec3(motion.velocity + wall.velocity) : Vec3(Vec3::Zero());
    result.is_dragged = result.is_dragged || wall.no_slip;
    result.factor = factor.cwiseProduct(result.factor);
    result.shift = factor.cwiseProduct(result.shift - of_wall) + of_wall;
  }
  return result;
}

bool is_dragged_by_all_images(const Model& model) {
  if (!has_viscous_images(model) || has_several_liquids(model)) return false;
  const bool is_everywhere = model.no_slip_walls.size() == model.walls.size();
  return is_everywhere || is_thick(liquid_of(model, 0), model.scene.dimensions);
}

namespace {

/// Sets the motions of sources for the sum PairSums::drag. The pressure of a source states whether
/// the source takes part: for an image itself, for a particle all its images.
void set_motions(const StepContext& c, const std::vector<Vec3>& velocities, bool walls_move) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const std::span<const Index> order = buffers.liquid.grid.order();
  const ImageVelocities velocity_of(*model.scene.vat, motion_of(c), walls_move);
  const auto is_thick_at = [&](Index i) -> Real {
    return is_thick(liquid_of(model, i), model.scene.dimensions);
  };
  const auto image_motion = [&](const PairImage& image, const PairMotion& source, Real thick) {
    const bool is_mirrored = image.axes[0] || image.axes[1] || image.axes[2];
    if (image.source >= order.size() || !is_mirrored) return PairMotion{};
    return vat::motion_of(velocity_of.is_dragged(image) ? 1 : thick,
                          velocity_of(image, {source.vx, source.vy, source.vz}));
  };
  const auto solid_motion = [](std::size_t) { return PairMotion{}; };
  if (!has_several_liquids(model)) {
    buffers.sources.set_other_motions(
        c.runner, solid_motion,
        [&, thick = is_thick_at(0)](const PairImage& image, const PairMotion& source) {
          return image_motion(image, source, thick);
        });
    return;
  }
  buffers.sources.set_motions(
      c.runner,
      [&](std::size_t s) { return vat::motion_of(is_thick_at(order[s]), velocities[order[s]]); },
      solid_motion,
      [&](const PairImage& image, const PairMotion& source) {
        return image_motion(image, source, source.pressure);
      });
}

}  // namespace

void add_viscous_image_forces(const StepContext& c, const std::vector<Vec3>& velocities,
                              bool walls_move, std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const std::span<const Index> order = buffers.liquid.grid.order();
  set_motions(c, velocities, walls_move);
  const bool differ = has_several_liquids(model);
  if (differ) set_image_viscosities(c);
  PairInputs inputs = force_inputs(c);
  inputs.first_mirrored = buffers.sources.first_mirrored_liquid();
  inputs.images_decide = !differ;
  const PairSums& table = pair_sums_of(c);
  const auto factor =
      by_material(model, [&](const LiquidModel& liquid) { return slope_factor(model, liquid); });
  buffers.liquid_clusters.for_some_sums<3>(
      c.runner, inputs, table.drag,
      [](const TargetCluster& cluster) { return cluster.has_mirrored; },
      [&](const TargetCluster&, Index s, const Real* sums) {
        const Index i = order[s];
        force[i] += model.rest_volume[i] * factor[model.material[i]] * Eigen::Map<const Vec3>(sums);
      });
}

void add_viscous_image_forces(StepContext& c) {
  add_viscous_image_forces(c, c.configuration.velocity, true, c.forces.particle);
}

}  // namespace vat
