#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <span>

#include "core/limits.h"
#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// Functions that search the neighbours of liquid particles, and visit them in the same pass.
namespace vat {

inline const LiquidModel& liquid_of(const Model& model, std::size_t particle) {
  return *model.liquids[model.material[particle]];
}

/// Resizes `slots` to at least `wanted` elements. The size grows by at least a quarter; a
/// std::vector would double the capacity.
inline void make_room(std::vector<Index>& slots, std::size_t wanted) {
  if (slots.size() >= wanted) return;
  const std::size_t size = std::max(wanted, slots.size() + slots.size() / 4);
  slots.reserve(size);
  slots.resize(size);
}

/// Writes the slots closer to `place` than `support` [m], except `self`, to `found` from index
/// `count` on. Returns the new count. Every candidate is written, and only neighbours increase the
/// count, which avoids mispredicted branches.
inline std::size_t find_near(const CellSortedPoints& points, const Vec3& place, Index self,
                             Real support, std::vector<Index>& found, std::size_t count) {
  // Number of candidates for which space is allocated at once. A cell may contain all particles.
  constexpr Index kChunk = 1024;
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

/// Writes the neighbours of slot `self` to `found` from index `count` on, as find_near(). In a
/// periodic world, the neighbours include images. Returns the new count.
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

/// Removes slots whose material differs from that of slot `self` from found[first, count). Returns
/// the new count.
inline std::size_t keep_material(const Model& model, std::span<const Index> order, Index self,
                                 std::vector<Index>& found, std::size_t first, std::size_t count) {
  const Index material = model.material[order[self]];
  const auto begin = found.begin();
  const auto kept = std::remove_if(
      begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(count),
      [&](Index slot) { return model.material[order[slot]] != material; });
  return static_cast<std::size_t>(kept - begin);
}

/// Finds the pairs of one block of slots, and calls visit(slot, slots of neighbours) for each slot.
/// When all blocks together have more than `most` pairs, the remaining slots get no neighbours.
template <bool periodic, class Visit>
void fill_block(const Model& model, Scratch& work, std::size_t begin, std::size_t end,
                std::atomic<std::size_t>& pair_count, std::size_t most, Visit&& visit) {
  LiquidScratch& buffers = work.of<LiquidScratch>();
  const CellSortedPoints& points = buffers.liquid;
  const std::span<const Index> order = points.grid.order();
  PairBlock& pairs = buffers.liquid_pairs[begin / kBlockSize];
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

/// Fills liquid_pairs, and calls visit(slot, slots of neighbours) for each slot. If a collapsed
/// liquid has more than max_pairs() pairs, sets too_many_pairs, and one density to NaN, so that the
/// step fails.
template <bool periodic, class Visit>
void find_pairs(const Model& model, Scratch& work, TaskRunner* runner, Visit&& visit) {
  LiquidScratch& buffers = work.of<LiquidScratch>();
  const std::size_t slots = buffers.liquid.grid.order().size();
  buffers.density.resize(model.liquid_count);
  buffers.liquid_pairs.resize(block_count(slots));
  const std::size_t most = max_pairs(model.liquid_count);
  std::atomic<std::size_t> pair_count = 0;
  for_blocks(runner, slots, [&](std::size_t begin, std::size_t end) {
    fill_block<periodic>(model, work, begin, end, pair_count, most, visit);
  });
  buffers.too_many_pairs = pair_count > most;
  // One NaN suffices for the guard (core/guard/guard.h). Which blocks are incomplete depends on the
  // threads.
  if (buffers.too_many_pairs) buffers.density[0] = std::numeric_limits<Real>::quiet_NaN();
}

}  // namespace vat
