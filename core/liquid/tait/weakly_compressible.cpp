#include "core/liquid/tait/weakly_compressible.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <limits>

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/viscous_images.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Counts the walls that are near to a point.
class NearWalls {
 public:
  NearWalls(const Model& model, const VatMotion& motion, Real distance) {
    low_.setConstant(-std::numeric_limits<Real>::infinity());
    high_.setConstant(std::numeric_limits<Real>::infinity());
    for (const int wall : model.walls) {
      const int axis = wall / 2;
      const Vat& vat = *model.scene.vat;
      if (wall % 2 == 0) {
        low_[axis] = vat.min[axis] + motion.offset[axis] + distance;
      } else {
        high_[axis] = vat.max[axis] + motion.offset[axis] - distance;
      }
    }
  }
  int count(const Vec3& place) const {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      count +=
          static_cast<int>(place[axis] < low_[axis]) + static_cast<int>(place[axis] > high_[axis]);
    }
    return count;
  }

 private:
  Vec3 low_;
  Vec3 high_;
};

/// The part of s_i to subtract, because a particle and its own images in walls, up to seven in a
/// corner, must not exceed the density at rest. A single particle then has no pressure, and the
/// mirror reflects it in a corner as at a face. With their pressure, it would be on a spring of up
/// to six times c / h, and the step allows for half of that.
Real own_excess(const StepContext& c, const VatMotion& motion, Index i, const Vec3& place) {
  const LiquidModel& liquid = liquid_of(c.model, i);
  const Real volume = c.model.rest_volume[i];
  Real own = liquid.kernel.value(0);
  // An image is as far beyond a wall, edge or corner as the particle is inside.
  for_each_mirror(c.model, motion, place, liquid.support_radius / 2, [&](const Mirror& mirror) {
    const Real r = (place - mirror.place(place)).norm();
    if (r < liquid.support_radius) own += liquid.kernel.value(r);
  });
  return std::max(Real{0}, volume * own - 1);
}

}  // namespace

void find_pair_clusters(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  Scratch& work = c.work;
  const Real reach = support_of(c.model);
  if (buffers.sources.is_current(c) && buffers.pairs_version == buffers.sources.version()) {
    if (has_solids(c.model)) buffers.sources.set_weights(c, {});
    return;
  }
  buffers.sources.build(c, reach);
  VAT_CHECK(c.model.is_coupled);
  const auto groups = buffers.sources.groups(buffers.liquid.grid, buffers.solids_in_liquid.grid);
  PairSearch search;
  search.reach = reach;
  search.padding = static_cast<Index>(buffers.sources.count());
  search.first_mirrored = buffers.sources.first_mirrored();
  search.most_work = max_pair_work(c.model.liquid_count);
  search.instructions = work.instructions;
  const SearchCoordinates& places = buffers.sources.search_coordinates();
  bool is_whole = buffers.liquid_clusters.build(search, groups[0], places, groups, c.runner);
  if (has_solids(c.model)) {
    const auto liquid = buffers.sources.liquid_groups(buffers.liquid.grid);
    is_whole &= buffers.solid_clusters.build(search, groups[1], places, liquid, c.runner);
  }
  buffers.too_many_pairs = !is_whole;
  buffers.pairs_version = buffers.sources.version();
}

void compute_tait_density(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  if (buffers.density_version == buffers.sources.version()) return;
  const VatMotion motion = motion_of(c);
  const NearWalls walls(model, motion, support_of(model) / 2);
  const CellSortedPoints& points = buffers.liquid;
  const std::span<const Index> order = points.grid.order();
  buffers.density.resize(model.liquid_count);
  const PairSums& table = pair_sums_of(c);
  const auto factor =
      by_material(model, [&](const LiquidModel& liquid) { return scale_factor(model, liquid); });
  const auto rest_density =
      by_material(model, [](const LiquidModel& liquid) { return liquid.rest_density; });
  const auto own_value =
      by_material(model, [](const LiquidModel& liquid) { return liquid.kernel.value(0); });
  const auto set_density = [&](const TargetCluster& cluster, Index slot, const Real* sums) {
    const Index i = order[slot];
    const Index material = model.material[i];
    Real sum = *sums * factor[material];
    if (cluster.has_mirrored && sum > 1) {
      const Vec3 place(points.x[slot], points.y[slot], points.z[slot]);
      const int near = walls.count(place);
      // An image adds at most the value at distance 0, and n walls have at most 2^n - 1 images.
      const Real most = model.rest_volume[i] * own_value[material] * static_cast<Real>(1 << near);
      if (near > 0 && most > 1) sum -= own_excess(c, motion, i, place);
    }
    buffers.density[i] = rest_density[material] * sum;
  };
  if (model.is_incompressible && !has_solids(model)) {
    buffers.volume_slopes.resize(order.size());
    const auto set_both = [&](const TargetCluster& cluster, Index slot, const Real* sums) {
      set_density(cluster, slot, sums);
      buffers.volume_slopes[slot] = {Eigen::Map<const Vec3>(sums + 1), sums[4]};
    };
    buffers.liquid_clusters.for_each_sum<kVolumeSums>(c.runner, pair_inputs(c), table.volume,
                                                      set_both);
  } else {
    buffers.liquid_clusters.for_each_sum<1>(c.runner, pair_inputs(c), table.density, set_density);
  }
  // One particle suffices for the guard. The incomplete clusters depend on the threads.
  if (buffers.too_many_pairs) buffers.density[0] = std::numeric_limits<Real>::quiet_NaN();
  buffers.density_version = buffers.sources.version();
}

void compute_tait_pressure(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  buffers.pressure.resize(c.model.liquid_count);
  VAT_CHECK(buffers.density.size() == c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, i);
      const Real s = buffers.density[i] / liquid.rest_density;
      const Real pressure = liquid.rest_density * liquid.stiffness * tait_pressure(s);
      buffers.pressure[i] =
          c.model.is_filled ? pressure : std::max(least_pressure(liquid, s), pressure);
    }
  });
}

namespace {

/// p / s^2 of liquid particle i.
Real pressure_term(const StepContext& c, Index i) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Real s = buffers.density[i] / liquid_of(c.model, i).rest_density;
  return buffers.pressure[i] / (s * s);
}

/// Sets pressures and velocities, including those of images.
template <class Image>
void set_motions(StepContext& c, Image&& image_motion) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const std::span<const Index> order = buffers.liquid.grid.order();
  const std::span<const Index> solids = buffers.solids_in_liquid.grid.order();
  const std::vector<Vec3>& velocity = c.configuration.velocity;
  buffers.sources.set_motions(
      c.runner,
      [&](std::size_t s) { return motion_of(pressure_term(c, order[s]), velocity[order[s]]); },
      [&](std::size_t s) {
        return motion_of(buffers.solid_pressure[s], velocity[c.model.liquid_count + solids[s]]);
      },
      image_motion);
}

void set_motions(StepContext& c) {
  const ImageMotion with_turned_velocity(c);
  if (!is_dragged_by_all_images(c.model)) return set_motions(c, with_turned_velocity);
  const ImageVelocities velocity_of(*c.model.scene.vat, motion_of(c), true);
  set_motions(c, [&](const PairImage& image, const PairMotion& source) {
    PairMotion motion = with_turned_velocity(image, source);
    if (image.walls == 0) return motion;
    const Vec3 velocity = velocity_of(image, {source.vx, source.vy, source.vz});
    return motion_of(motion.pressure, velocity);
  });
}

}  // namespace

void add_tait_forces(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  VAT_CHECK(buffers.pressure.size() == c.model.liquid_count &&
            c.forces.particle.size() == c.model.particle_count);
  set_motions(c);
  const PairSums& table = pair_sums_of(c);
  add_pair_forces(c, has_central_viscosity(model) ? table.force : table.pressure,
                  c.forces.particle);
}

void add_pair_forces(const StepContext& c, PairSums::Function sum, std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const std::span<const Index> order = buffers.liquid.grid.order();
  if (has_several_liquids(model)) set_liquid_viscosities(c);
  const PairInputs inputs =
      is_dragged_by_all_images(model) ? dragging_force_inputs(c) : force_inputs(c);
  const auto factor =
      by_material(model, [&](const LiquidModel& liquid) { return slope_factor(model, liquid); });
  buffers.liquid_clusters.for_each_sum<3>(
      c.runner, inputs, sum, [&](const TargetCluster&, Index slot, const Real* sums) {
        const Index i = order[slot];
        force[i] += model.rest_volume[i] * factor[model.material[i]] * Eigen::Map<const Vec3>(sums);
      });
}

}  // namespace vat
