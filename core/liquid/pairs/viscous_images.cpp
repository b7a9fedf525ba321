#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/pairs/scratch.h"
#include "core/model/acting_forces.h"

#include "core/evaluation/force_model.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The mirrored velocity: v -> factor v + shift, axis by axis.
struct MirroredVelocity {
  bool is_dragged = false;  ///< at least one of its walls is no_slip
  Vec3 factor = Vec3::Ones();
  Vec3 shift = Vec3::Zero();
};

/// The mirrored velocity for a mirror seen from `place` inside: one wall after the other, each in
/// its own frame. A slip wall keeps the velocity along it.
MirroredVelocity mirrored_velocity(const Vat& vat, const VatMotion& motion, const Mirror& mirror,
                                   const Vec3& place) {
  MirroredVelocity result;
  for (int axis = 0; axis < 3; ++axis) {
    if (!mirror.axes[static_cast<std::size_t>(axis)]) continue;
    const bool is_low = 2 * place[axis] > mirror.twice_plane[axis];
    const Wall& wall = vat.walls[2 * static_cast<std::size_t>(axis) + (is_low ? 0 : 1)];
    Vec3 factor = Vec3::Constant(wall.no_slip ? -1 : 1);
    factor[axis] = -1;
    const Vec3 of_wall = motion.velocity + wall.velocity;
    result.is_dragged = result.is_dragged || wall.no_slip;
    result.factor = factor.cwiseProduct(result.factor);
    result.shift = factor.cwiseProduct(result.shift - of_wall) + of_wall;
  }
  return result;
}

/// Calls f(particle, mirrored velocity, strength by axis) for the images of liquid near slot `self`
/// that take part.
template <class F>
void for_each_viscous_image(const Model& model, const Scratch& work, const VatMotion& motion,
                            Index self, F&& f) {
  const CellSortedPoints& points = work.of<LiquidScratch>().liquid;
  const std::span<const Index> order = points.grid.order();
  const LiquidModel& liquid = liquid_of(model, order[self]);
  const Vec3 place(points.x[self], points.y[self], points.z[self]);
  const int dimensions = model.scene.dimensions;
  const bool is_own_thick = is_thick(liquid, dimensions);
  const auto drag = [&](Index slot, const Vec3& x, const Mirror& mirror) {
    const MirroredVelocity velocity = mirrored_velocity(*model.scene.vat, motion, mirror, place);
    const LiquidModel& other = liquid_of(model, order[slot]);
    if (!velocity.is_dragged && !is_own_thick && !is_thick(other, dimensions)) return;
    const Real r = x.norm();
    const Real volumes = model.rest_volume[order[self]] * model.rest_volume[order[slot]];
    const Real strength = -mean_viscosity(liquid, other) * volumes * liquid.slope_scale *
                          liquid.kernel.slope_over_r(r) / softened_square(liquid, r);
    f(order[slot], velocity, Vec3(strength * x.cwiseAbs2()));
  };
  for_each_image(model, motion, points, place, liquid.support_radius, drag);
}

}  // namespace

// The pressure of a source tells whether it takes part: for an image itself, for a particle all its
// images.
void add_viscous_image_forces(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const VatMotion motion = motion_of(c);
  const std::span<const Index> order = buffers.liquid.grid.order();
  const std::vector<Vec3>& velocities = c.configuration.velocity;
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
        const MirroredVelocity mirrored = mirrored_velocity(*model.scene.vat, motion, mirror,
                                                            buffers.sources.place(image.source));
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
        c.forces.particle[i] +=
            model.rest_volume[i] * factor[model.material[i]] * Eigen::Map<const Vec3>(sums);
      });
}

void ViscousImages::collect(const ForceModel& f, Real time) {
  VAT_CHECK(f.model.scene.vat.has_value());
  const VatMotion motion = vat_motion(*f.model.scene.vat, time);
  const std::size_t count = f.work.of<LiquidScratch>().liquid.grid.order().size();
  blocks_.resize(block_count(count));
  for_blocks(f.runner, count, [&](std::size_t begin, std::size_t end) {
    Block& block = blocks_[begin / kBlockSize];
    block.images.clear();
    for (std::size_t s = begin; s < end; ++s) {
      block.begin[s - begin] = static_cast<Index>(block.images.size());
      for_each_viscous_image(f.model, f.work, motion, static_cast<Index>(s),
                             [&](Index j, const MirroredVelocity& mirrored, const Vec3& strength) {
                               block.images.push_back({j, strength, mirrored.factor});
                             });
    }
    block.begin[end - begin] = static_cast<Index>(block.images.size());
  });
}

void ViscousImages::add(const ForceModel& f, const std::vector<Vec3>& w,
                        std::vector<Vec3>& force) const {
  const std::span<const Index> order = f.work.of<LiquidScratch>().liquid.grid.order();
  VAT_CHECK(blocks_.size() == block_count(order.size()) && force.size() >= order.size());
  for_blocks(f.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const Block& block = blocks_[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const Index i = order[s];
      Vec3 sum = Vec3::Zero();
      for (Index k = block.begin[s - begin]; k < block.begin[s - begin + 1]; ++k) {
        const Image& image = block.images[k];
        sum -= image.strength.cwiseProduct(w[i] - image.factor.cwiseProduct(w[image.other]));
      }
      force[i] += sum;
    }
  });
}

}  // namespace vat
