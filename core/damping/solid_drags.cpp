#include "core/damping/solid_drags.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>

#include "core/evaluation/force_model.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {

void SolidDrags::collect_of(const ForceModel& f, const CellSortedPoints& from, Index first,
                            const CellSortedPoints& to, Index other_first,
                            const std::vector<PairBlock>& near, std::vector<Block>& blocks) {
  VAT_CHECK(near.size() == block_count(from.grid.order().size()));
  const Model& model = f.model;
  const std::size_t count = from.grid.order().size();
  blocks.resize(block_count(count));
  for_blocks(f.runner, count, [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = near[begin / kBlockSize];
    Block& block = blocks[begin / kBlockSize];
    block.drags.clear();
    for (std::size_t s = begin; s < end; ++s) {
      const Index i = first + from.grid.order()[s];
      block.begin[s - begin] = static_cast<Index>(block.drags.size());
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Index slot = pairs.slots[k];
        const Index j = other_first + to.grid.order()[slot];
        const Vec3 x = nearest_image(
            model, Vec3(from.x[s] - to.x[slot], from.y[s] - to.y[slot], from.z[s] - to.z[slot]));
        const LiquidModel& liquid = liquid_of(model, std::min(i, j));
        const Real r = x.norm();
        if (r >= liquid.support_radius) continue;
        const Real strength = -liquid.central_viscosity * liquid.slope_scale *
                              model.rest_volume[i] * model.rest_volume[j] *
                              liquid.kernel.slope_over_r(r) / softened_square(liquid, r);
        block.drags.push_back({j, strength, x});
      }
    }
    block.begin[end - begin] = static_cast<Index>(block.drags.size());
  });
}

void SolidDrags::add_of(const ForceModel& f, const CellSortedPoints& from, Index first,
                        const std::vector<Block>& blocks, const std::vector<Vec3>& w,
                        std::vector<Vec3>& force) {
  const std::span<const Index> order = from.grid.order();
  for_blocks(f.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const Block& block = blocks[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const Index i = first + order[s];
      Vec3 sum = Vec3::Zero();
      for (Index k = block.begin[s - begin]; k < block.begin[s - begin + 1]; ++k) {
        const Drag& drag = block.drags[k];
        sum -= drag.strength * (w[i] - w[drag.other]).dot(drag.x) * drag.x;
      }
      force[i] += sum;
    }
  });
}

void SolidDrags::collect(const ForceModel& f) {
  LiquidScratch& buffers = f.work.of<LiquidScratch>();
  const Index solids = f.model.liquid_count;
  collect_of(f, buffers.liquid, 0, buffers.solids_in_liquid, solids, buffers.solids_of_liquid,
             of_liquid_);
  collect_of(f, buffers.solids_in_liquid, solids, buffers.liquid, 0, buffers.liquid_of_solids,
             of_solids_);
}

void SolidDrags::add(const ForceModel& f, const std::vector<Vec3>& w,
                     std::vector<Vec3>& force) const {
  LiquidScratch& buffers = f.work.of<LiquidScratch>();
  add_of(f, buffers.liquid, 0, of_liquid_, w, force);
  add_of(f, buffers.solids_in_liquid, f.model.liquid_count, of_solids_, w, force);
}

}  // namespace vat
