#include <algorithm>

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/tait/weakly_compressible.h"
#include "core/support/check.h"

// Solids in weakly compressible liquids.

namespace vat {

void sort_solids_in_liquid(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  c.work.of<LiquidScratch>().solids_in_liquid.update(
      points.subspan(c.model.liquid_count), pair_cell_size(c.model), c.model.periodic, c.runner);
}

// The mean pressure around a position, weighted with the kernel and extrapolated by the weight of
// the liquid in between.
void extrapolate_pressure(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  VAT_CHECK(buffers.pressure.size() == c.model.liquid_count);
  const CellSortedPoints& solids = buffers.solids_in_liquid;
  const std::span<const Index> order = buffers.liquid.grid.order();
  const std::size_t count = solids.grid.order().size();
  const Real support = support_of(model);
  const ImageMotion image_motion(c);
  buffers.sources.set_motions(
      c.runner,
      [&](std::size_t s) {
        return PairMotion{buffers.pressure[order[s]], liquid_of(model, order[s]).rest_density, 0,
                          0};
      },
      [](std::size_t) { return PairMotion{}; },
      [&](const PairImage& image, const PairMotion& source) {
        return PairMotion{image_motion(image, source).pressure, source.vx, 0, 0};
      });
  buffers.solid_pressure.resize(count);
  const auto set_pressure = [&](const TargetCluster&, Index target, const Real* sums) {
    const std::size_t s = target - buffers.sources.first_solid();
    const Vec3 fall = fall_in_vat(model, {}, {solids.x[s], solids.y[s], solids.z[s]});
    const Real weight = sums[3];
    const Real sum = sums[4] + support * fall.dot(Eigen::Map<const Vec3>(sums));
    const Real mean = weight > 0 ? sum / weight : 0;
    buffers.solid_pressure[s] = model.is_filled ? mean : std::max(Real{0}, mean);
  };
  buffers.solid_clusters.for_each_sum<kMeanSums>(c.runner, solid_force_inputs(c),
                                                 pair_sums_of(c).mean, set_pressure);
}

void add_tait_forces_on_solids(StepContext& c) {
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  const PairSums& table = pair_sums_of(c);
  add_pair_forces_on_solids(c, has_central_viscosity(c.model) ? table.force : table.pressure,
                            c.forces.particle);
}

void add_pair_forces_on_solids(const StepContext& c, PairSums::Function sum,
                               std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const std::span<const Index> order = buffers.solids_in_liquid.grid.order();
  if (has_several_liquids(model)) set_solid_viscosities(c);
  set_slope_weights(c);
  const Real factor = slope_factor(model, *model.liquids[model.material[0]]);
  buffers.solid_clusters.for_each_sum<3>(
      c.runner, solid_force_inputs(c), sum,
      [&](const TargetCluster&, Index target, const Real* sums) {
        const Index b = model.liquid_count + order[target - buffers.sources.first_solid()];
        force[b] += model.rest_volume[b] * factor * Eigen::Map<const Vec3>(sums);
      });
}

}  // namespace vat
