#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <span>

#include "core/limits.h"
#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// The neighbours of liquid particles, found and summed over in one pass.
namespace vat {

inline const LiquidModel& liquid_of(const Model& model, std::size_t particle) {
  return *model.liquids[model.material[particle]];
}

/// Makes room for `wanted` slots; by quarters, since a vector by itself would double.
inline void make_room(std::vector<Index>& slots, std::size_t wanted) {
  if (slots.size() >= wanted) return;
  const std::size_t size = std::max(wanted, slots.size() + slots.size() / 4);
  slots.reserve(size);
  slots.resize(size);
}

/// Slots nearer to `place` than `support`, but `self`, appended to `found` from `count` on; the new
/// count. Every candidate is written and only a neighbour advances the count: no branch to
/// mispredict.
inline std::size_t find_near(const CellSortedPoints& points, const Vec3& place, Index self,
                             Real support, std::vector<Index>& found, std::size_t count) {
  constexpr Index kChunk = 1024;  // room for candidates at a time: a crowded cell may hold them all
  const Real x = place.x();
  const Real y = place.y();
  const Real z = place.z();
  const Real support2 = support * support;
  points.grid.for_each_run({x, y, z}, support, [&](Index begin, Index end) {
    while (begin < end) {
      const Index stop = std::min(end, begin + kChunk);
      make_room(found, count + (stop - begin));
      Index* const out = found.data();
      for (Index slot = begin; slot < stop; ++slot) {
        const Real dx = points.x[slot] - x;
        const Real dy = points.y[slot] - y;
        const Real dz = points.z[slot] - z;
        out[count] = slot;
        count +=
            static_cast<std::size_t>((dx * dx + dy * dy + dz * dz < support2) & (slot != self));
      }
      begin = stop;
    }
  });
  return count;
}

/// The neighbours of slot `self`, in the same way; in a periodic world, of all its images.
template <bool periodic>
std::size_t find_neighbours(const PeriodicBox& box, const CellSortedPoints& points, Index self,
                            Real support, std::vector<Index>& found, std::size_t count) {
  const Vec3 place(points.x[self], points.y[self], points.z[self]);
  if constexpr (!periodic) return find_near(points, place, self, support, found, count);
  box.for_each_image(place, support, [&](const Vec3& shift) {
    count = find_near(points, place + shift, self, support, found, count);
  });
  return count;
}

/// Keeps of found[first, count) the slots of the same material as slot `self`.
inline std::size_t keep_material(const Model& model, std::span<const Index> order, Index self,
                                 std::vector<Index>& found, std::size_t first, std::size_t count) {
  const Index material = model.material[order[self]];
  const auto begin = found.begin();
  const auto kept = std::remove_if(
      begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(count),
      [&](Index slot) { return model.material[order[slot]] != material; });
  return static_cast<std::size_t>(kept - begin);
}

/// Fills one block's pairs, and calls visit(slot, slots of neighbours) for each. Once the blocks
/// together have found more than `most`, the rest get no neighbours.
template <bool periodic, class Visit>
void fill_block(const Model& model, Scratch& work, std::size_t begin, std::size_t end,
                std::atomic<std::size_t>& pair_count, std::size_t most, Visit&& visit) {
  const CellSortedPoints& points = work.of<LiquidScratch>().liquid;
  const std::span<const Index> order = points.grid.order();
  PairBlock& pairs = work.of<LiquidScratch>().liquid_pairs[begin / kBlockSize];
  std::size_t count = 0;
  for (std::size_t s = begin; s < end; ++s) {
    const auto self = static_cast<Index>(s);
    const std::size_t first = count;
    pairs.begin[s - begin] = static_cast<Index>(first);
    if (pair_count.load(std::memory_order_relaxed) <= most) {
      const Real support = liquid_of(model, order[self]).support_radius;
      count = find_neighbours<periodic>(model.periodic, points, self, support, pairs.slots, count);
      if (model.liquids_touch) {
        count = keep_material(model, order, self, pairs.slots, first, count);
      }
      pair_count.fetch_add(count - first, std::memory_order_relaxed);
    }
    visit(self, std::span<const Index>(pairs.slots).subspan(first, count - first));
  }
  pairs.begin[end - begin] = static_cast<Index>(count);
}

/// Fills liquid_pairs, and calls visit(slot, slots of neighbours) for each slot. Where a collapsed
/// liquid has more than max_pairs() of them, says so in the workspace and leaves a density that is
/// not a number, so that the step fails.
template <bool periodic, class Visit>
void find_pairs(const Model& model, Scratch& work, TaskRunner* runner, Visit&& visit) {
  const std::size_t slots = work.of<LiquidScratch>().liquid.grid.order().size();
  work.of<LiquidScratch>().density.resize(model.liquid_count);
  work.of<LiquidScratch>().liquid_pairs.resize(block_count(slots));
  const std::size_t most = max_pairs(model.liquid_count);
  std::atomic<std::size_t> pair_count = 0;
  for_blocks(runner, slots, [&](std::size_t begin, std::size_t end) {
    fill_block<periodic>(model, work, begin, end, pair_count, most, visit);
  });
  work.of<LiquidScratch>().too_many_pairs = pair_count > most;
  // One particle is enough for the guard to see; which blocks were cut off depends on threads.
  if (work.of<LiquidScratch>().too_many_pairs)
    work.of<LiquidScratch>().density[0] = std::numeric_limits<Real>::quiet_NaN();
}

}  // namespace vat
