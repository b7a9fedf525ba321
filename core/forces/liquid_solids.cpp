#include <algorithm>

#include "core/forces/liquid_pairs.h"
#include "core/forces/weakly_compressible.h"
#include "core/forces/weakly_compressible_pairs.h"

// Solids in a weakly compressible liquid.

namespace vat {

void find_liquid_solids(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  const Index first = c.model.liquid_count;
  Real support = 0;
  for (const auto& liquid : c.model.liquids) {
    if (liquid) support = std::max(support, liquid->support_radius);
  }
  c.work.solids_in_liquid.build(points.subspan(first), support, c.model.periodic);
  const auto find = [&](const CellSortedPoints& from, const CellSortedPoints& to,
                        std::vector<PairBlock>& blocks, auto&& support_of) {
    const std::size_t count = from.grid.order().size();
    blocks.resize((count + kBlockSize - 1) / kBlockSize);
    for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
      PairBlock& block = blocks[begin / kBlockSize];
      std::size_t found = 0;
      for (std::size_t s = begin; s < end; ++s) {
        block.begin[s - begin] = static_cast<Index>(found);
        const Vec3 place(from.x[s], from.y[s], from.z[s]);
        const Real radius = support_of(s);
        c.model.periodic.for_each_image(place, radius, [&](const Vec3& shift) {
          found = find_near(to, place + shift, kNoParticle, radius, block.slots, found);
        });
      }
      block.begin[end - begin] = static_cast<Index>(found);
    });
  };
  const std::span<const Index> order = c.work.liquid.grid.order();
  find(c.work.liquid, c.work.solids_in_liquid, c.work.solids_of_liquid,
       [&](std::size_t slot) { return liquid_of(c.model, order[slot]).support_radius; });
  find(c.work.solids_in_liquid, c.work.liquid, c.work.liquid_of_solids,
       [&](std::size_t) { return support; });
}

void extrapolate_pressure(StepContext& c) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const std::span<const Index> order = solids.grid.order();
  const std::span<const Index> liquid_order = c.work.liquid.grid.order();
  const VatMotion still;
  c.work.solid_pressure.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& near = c.work.liquid_of_solids[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const Vec3 place(solids.x[s], solids.y[s], solids.z[s]);
      const Vec3 fall = fall_in_vat(c.model, still, place);
      Real weight = 0;
      Real pressure = 0;
      for (Index k = near.begin[s - begin]; k < near.begin[s - begin + 1]; ++k) {
        const Index slot = near.slots[k];
        const Index f = liquid_order[slot];
        const LiquidModel& liquid = liquid_of(c.model, f);
        const Vec3 x = nearest_image(
            c.model,
            place - Vec3(c.work.liquid.x[slot], c.work.liquid.y[slot], c.work.liquid.z[slot]));
        const Real r = x.norm();
        if (r >= liquid.support_radius) continue;
        const Real w = liquid.kernel.value(r);
        weight += w;
        pressure += w * (c.work.pressure[f] + liquid.rest_density * fall.dot(x));
      }
      c.work.solid_pressure[s] = weight > 0 ? std::max(Real{0}, pressure / weight) : 0;
    }
  });
}

void add_tait_forces_on_solids(StepContext& c) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const std::span<const Index> order = solids.grid.order();
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& near = c.work.liquid_of_solids[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const Index b = c.model.liquid_count + order[s];
      const Vec3 place(solids.x[s], solids.y[s], solids.z[s]);
      Vec3 sum = Vec3::Zero();
      for (Index k = near.begin[s - begin]; k < near.begin[s - begin + 1]; ++k) {
        const LiquidRecord& other = c.work.liquid_records[near.slots[k]];
        const LiquidModel& liquid = liquid_of(c.model, c.work.liquid.grid.order()[near.slots[k]]);
        const Vec3 x = nearest_image(c.model, other.position - place);
        const Real r = x.norm();
        if (r >= liquid.support_radius) continue;
        sum -= other.volume *
               central_force(liquid, liquid.central_viscosity,
                             other.pressure + c.work.solid_pressure[s],
                             other.velocity - c.configuration.velocity[b], x, r) *
               x;
      }
      c.forces.particle[b] += c.model.rest_volume[b] * sum;
    }
  });
}

}  // namespace vat
