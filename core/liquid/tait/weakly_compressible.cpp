#include "core/liquid/tait/weakly_compressible.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <limits>

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"

namespace vat {
namespace {

/// What of s_i a particle and its own images in walls, up to seven in a corner, may not have: they
/// do not count for more than liquid at rest. Alone they have no pressure, and the mirror turns
/// back what flies into a corner as it does at a face. By their pressure they would be on a spring
/// of up to six times c / h, where a step allows for half of that.
Real own_excess(const StepContext& c, const VatMotion& motion, const LiquidModel& liquid,
                std::size_t slot) {
  const CellSortedPoints& points = c.work.of<LiquidScratch>().liquid;
  const Vec3 place(points.x[slot], points.y[slot], points.z[slot]);
  Real own = liquid.kernel.value(0);
  // An image is as far beyond a wall, edge or corner as the particle is inside.
  for_each_mirror(c.model, motion, place, liquid.support_radius / 2, [&](const Mirror& mirror) {
    const Real r = (place - mirror.place(place)).norm();
    if (r < liquid.support_radius) own += liquid.kernel.value(r);
  });
  return std::max(Real{0}, c.model.rest_volume[points.grid.order()[slot]] * own - 1);
}

}  // namespace

void find_pair_clusters(StepContext& c) {
  Scratch& work = c.work;
  const Real reach = support_of(c.model);
  if (work.of<LiquidScratch>().sources.is_current(c) &&
      work.of<LiquidScratch>().pairs_version == work.of<LiquidScratch>().sources.version()) {
    if (has_solids(c.model)) work.of<LiquidScratch>().sources.set_weights(c, {});
    return;
  }
  work.of<LiquidScratch>().sources.build(c, reach);
  const auto groups = work.of<LiquidScratch>().sources.groups(
      work.of<LiquidScratch>().liquid.grid, work.of<LiquidScratch>().solids_in_liquid.grid);
  PairSearch search;
  search.reach = reach;
  search.padding = static_cast<Index>(work.of<LiquidScratch>().sources.count());
  search.first_mirrored = work.of<LiquidScratch>().sources.first_mirrored();
  search.most_work = max_pair_work(c.model.liquid_count);
  search.instructions = work.instructions;
  const SearchPlaces& places = work.of<LiquidScratch>().sources.search_places();
  bool is_whole =
      work.of<LiquidScratch>().liquid_clusters.build(search, groups[0], places, groups, c.runner);
  if (has_solids(c.model)) {
    const auto liquid =
        work.of<LiquidScratch>().sources.liquid_groups(work.of<LiquidScratch>().liquid.grid);
    is_whole &=
        work.of<LiquidScratch>().solid_clusters.build(search, groups[1], places, liquid, c.runner);
  }
  work.of<LiquidScratch>().too_many_pairs = !is_whole;
  work.of<LiquidScratch>().pairs_version = work.of<LiquidScratch>().sources.version();
}

void compute_tait_density(StepContext& c) {
  Scratch& work = c.work;
  const Model& model = c.model;
  if (work.of<LiquidScratch>().density_version == work.of<LiquidScratch>().sources.version())
    return;
  const VatMotion motion = motion_of(c);
  const std::span<const Index> order = work.of<LiquidScratch>().liquid.grid.order();
  work.of<LiquidScratch>().density.resize(model.liquid_count);
  const PairSums& table = pair_sums_of(c);
  const auto factor =
      by_material(model, [&](const LiquidModel& liquid) { return scale_factor(model, liquid); });
  const auto rest_density =
      by_material(model, [](const LiquidModel& liquid) { return liquid.rest_density; });
  const auto set_density = [&](const TargetCluster& cluster, Index slot, const Real* sums) {
    const Index i = order[slot];
    const Index material = model.material[i];
    Real sum = *sums * factor[material];
    if (cluster.has_mirrored && sum > 1) sum -= own_excess(c, motion, liquid_of(model, i), slot);
    work.of<LiquidScratch>().density[i] = rest_density[material] * sum;
  };
  if (model.is_incompressible && !has_solids(model)) {
    work.of<LiquidScratch>().volume_slopes.resize(order.size());
    const auto set_both = [&](const TargetCluster& cluster, Index slot, const Real* sums) {
      set_density(cluster, slot, sums);
      work.of<LiquidScratch>().volume_slopes[slot] = {Eigen::Map<const Vec3>(sums + 1), sums[4]};
    };
    work.of<LiquidScratch>().liquid_clusters.for_each_sum<kVolumeSums>(c.runner, pair_inputs(c),
                                                                       table.volume, set_both);
  } else {
    work.of<LiquidScratch>().liquid_clusters.for_each_sum<1>(c.runner, pair_inputs(c),
                                                             table.density, set_density);
  }
  // One particle is enough for the guard to see; which clusters were cut off depends on threads.
  if (work.of<LiquidScratch>().too_many_pairs)
    work.of<LiquidScratch>().density[0] = std::numeric_limits<Real>::quiet_NaN();
  work.of<LiquidScratch>().density_version = work.of<LiquidScratch>().sources.version();
}

void compute_tait_pressure(StepContext& c) {
  c.work.of<LiquidScratch>().pressure.resize(c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, i);
      const Real s = c.work.of<LiquidScratch>().density[i] / liquid.rest_density;
      const Real pressure = liquid.rest_density * liquid.stiffness * tait_pressure(s);
      c.work.of<LiquidScratch>().pressure[i] =
          c.model.is_filled ? pressure : std::max(least_pressure(liquid, s), pressure);
    }
  });
}

namespace {

/// p / s^2 of liquid particle i.
Real pressure_term(const StepContext& c, Index i) {
  const Real s = c.work.of<LiquidScratch>().density[i] / liquid_of(c.model, i).rest_density;
  return c.work.of<LiquidScratch>().pressure[i] / (s * s);
}

/// Pressures and velocities, of images too.
void set_motions(StepContext& c) {
  Scratch& work = c.work;
  const std::span<const Index> order = work.of<LiquidScratch>().liquid.grid.order();
  const std::span<const Index> solids = work.of<LiquidScratch>().solids_in_liquid.grid.order();
  const std::vector<Vec3>& velocity = c.configuration.velocity;
  work.of<LiquidScratch>().sources.set_motions(
      c.runner,
      [&](std::size_t s) { return motion_of(pressure_term(c, order[s]), velocity[order[s]]); },
      [&](std::size_t s) {
        return motion_of(work.of<LiquidScratch>().solid_pressure[s],
                         velocity[c.model.liquid_count + solids[s]]);
      },
      ImageMotion(c));
}

}  // namespace

void add_tait_forces(StepContext& c) {
  Scratch& work = c.work;
  const Model& model = c.model;
  const std::span<const Index> order = work.of<LiquidScratch>().liquid.grid.order();
  set_motions(c);
  if (has_several_liquids(model)) set_liquid_viscosities(c);
  const PairSums& table = pair_sums_of(c);
  const auto sum = has_central_viscosity(model) ? table.force : table.pressure;
  const auto factor =
      by_material(model, [&](const LiquidModel& liquid) { return slope_factor(model, liquid); });
  work.of<LiquidScratch>().liquid_clusters.for_each_sum<3>(
      c.runner, force_inputs(c), sum, [&](const TargetCluster&, Index slot, const Real* sums) {
        const Index i = order[slot];
        c.forces.particle[i] +=
            model.rest_volume[i] * factor[model.material[i]] * Eigen::Map<const Vec3>(sums);
      });
}

}  // namespace vat
