#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/pairs/scratch.h"
#include "core/model/acting_forces.h"

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"

namespace vat {
namespace {

/// The mirrored velocity: v -> factor v + shift, axis by axis.
struct MirroredVelocity {
  bool is_dragged = false;  ///< at least one of its walls is no_slip
  Vec3 factor = Vec3::Ones();
  Vec3 shift = Vec3::Zero();
};

/// The mirrored velocity for a mirror seen from `place` inside: one wall after the other, each in
/// its own frame. A slip wall keeps the velocity along it. If `walls_move` is false, the walls are
/// at rest.
MirroredVelocity mirrored_velocity(const Vat& vat, const VatMotion& motion, bool walls_move,
                                   const Mirror& mirror, const Vec3& place) {
  MirroredVelocity result;
  for (int axis = 0; axis < 3; ++axis) {
    if (!mirror.axes[static_cast<std::size_t>(axis)]) continue;
    const bool is_low = 2 * place[axis] > mirror.twice_plane[axis];
    const Wall& wall = vat.walls[2 * static_cast<std::size_t>(axis) + (is_low ? 0 : 1)];
    Vec3 factor = Vec3::Constant(wall.no_slip ? -1 : 1);
    factor[axis] = -1;
    const Vec3 of_wall = walls_move ? Vec3(motion.velocity + wall.velocity) : Vec3(Vec3::Zero());
    result.is_dragged = result.is_dragged || wall.no_slip;
    result.factor = factor.cwiseProduct(result.factor);
    result.shift = factor.cwiseProduct(result.shift - of_wall) + of_wall;
  }
  return result;
}

}  // namespace

// The pressure of a source tells whether it takes part: for an image itself, for a particle all its
// images.
void add_viscous_image_forces(const StepContext& c, const std::vector<Vec3>& velocities,
                              bool walls_move, std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const VatMotion motion = motion_of(c);
  const std::span<const Index> order = buffers.liquid.grid.order();
  const auto is_thick_at = [&](Index i) -> Real {
    return is_thick(liquid_of(model, i), model.scene.dimensions);
  };
  buffers.sources.set_motions(
      c.runner,
      [&](std::size_t s) { return vat::motion_of(is_thick_at(order[s]), velocities[order[s]]); },
      [](std::size_t) { return PairMotion{}; },
      [&](const PairImage& image, const PairMotion& source) {
        const bool is_mirrored = image.axes[0] || image.axes[1] || image.axes[2];
        if (image.source >= order.size() || !is_mirrored) return PairMotion{};
        const Mirror mirror = image.mirror();
        const MirroredVelocity mirrored = mirrored_velocity(
            *model.scene.vat, motion, walls_move, mirror, buffers.sources.place(image.source));
        const Vec3 velocity(source.vx, source.vy, source.vz);
        return vat::motion_of(mirrored.is_dragged ? 1 : source.pressure,
                              mirrored.factor.cwiseProduct(velocity) + mirrored.shift);
      });
  if (has_several_liquids(model)) set_image_viscosities(c);
  PairInputs inputs = force_inputs(c);
  inputs.first_mirrored = buffers.sources.first_mirrored_liquid();
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
