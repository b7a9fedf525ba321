#include "core/liquid/pairs/neighbour_lists.h"
#include "core/liquid/pairs/scratch.h"

#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

template <bool periodic>
void list_liquid(StepContext& c) {
  const Model& model = c.model;
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const CellSortedPoints& points = buffers.liquid;
  const std::span<const Index> order = points.grid.order();
  buffers.liquid_records.resize(order.size());
  VAT_CHECK(model.rest_volume.size() == model.particle_count);
  find_pairs<periodic>(model, c.work, c.runner, [&](Index s, std::span<const Index>) {
    LiquidRecord& record = buffers.liquid_records[s];
    record.position = {points.x[s], points.y[s], points.z[s]};
    record.volume = model.rest_volume[order[s]];
  });
}

void list_near(const Model& model, const CellSortedPoints& from, const CellSortedPoints& to,
               TaskRunner* runner, std::vector<PairBlock>& blocks) {
  const Real support = support_of(model);
  const std::size_t count = from.grid.order().size();
  blocks.resize(block_count(count));
  for_blocks(runner, count, [&](std::size_t begin, std::size_t end) {
    PairBlock& block = blocks[begin / kBlockSize];
    std::size_t found = 0;
    for (std::size_t s = begin; s < end; ++s) {
      block.begin[s - begin] = static_cast<Index>(found);
      const Vec3 place(from.x[s], from.y[s], from.z[s]);
      model.periodic.for_each_image(place, support, [&](const Vec3& shift) {
        found = find_near(to, place + shift, kNoParticle, support, block.slots, found);
      });
    }
    block.begin[end - begin] = static_cast<Index>(found);
  });
}

}  // namespace

void list_neighbours(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  c.model.periodic.any() ? list_liquid<true>(c) : list_liquid<false>(c);
  if (!has_solids(c.model)) return;
  list_near(c.model, buffers.liquid, buffers.solids_in_liquid, c.runner, buffers.solids_of_liquid);
}

}  // namespace vat
