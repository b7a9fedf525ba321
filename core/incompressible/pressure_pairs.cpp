#include "core/incompressible/pressure_pairs.h"

#include "core/forces/liquid_pairs.h"
#include "core/forces/weakly_compressible_pairs.h"

namespace vat {
namespace {

Vec3 place_of(const CellSortedPoints& points, std::size_t slot) {
  return {points.x[slot], points.y[slot], points.z[slot]};
}

void fill_records(const StepContext& c, std::vector<LiquidRecord>& records) {
  const std::span<const Index> order = c.work.liquid.grid.order();
  records.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      records[s].position = place_of(c.work.liquid, s);
      records[s].volume = c.model.rest_volume[order[s]];
    }
  });
}

void fill_slopes(const StepContext& c, PressurePairs& pairs) {
  const std::span<const Index> order = c.work.liquid.grid.order();
  pairs.slopes.resize(block_count(order.size()));
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& block = c.work.liquid_pairs[begin / kBlockSize];
    std::vector<Real>& slopes = pairs.slopes[begin / kBlockSize];
    slopes.resize(block.begin[end - begin]);
    for (std::size_t s = begin; s < end; ++s) {
      const SmoothingKernel& kernel = liquid_of(c.model, order[s]).kernel;
      for (Index k = block.begin[s - begin]; k < block.begin[s - begin + 1]; ++k) {
        const Vec3 x = pairs.records[s].position - pairs.records[block.slots[k]].position;
        slopes[k] = kernel.slope_over_r(nearest_image(c.model, x).norm());
      }
    }
  });
}

/// Fills `blocks` with what find(slot, entries) appends for each of `count` slots.
template <class Find>
void fill_blocks(const StepContext& c, std::size_t count, std::vector<GradientBlock>& blocks,
                 Find&& find) {
  blocks.resize(block_count(count));
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    GradientBlock& block = blocks[begin / kBlockSize];
    block.entries.clear();
    for (std::size_t s = begin; s < end; ++s) {
      block.begin[s - begin] = static_cast<Index>(block.entries.size());
      find(static_cast<Index>(s), block.entries);
    }
    block.begin[end - begin] = static_cast<Index>(block.entries.size());
  });
}

/// What of `points` walls show within reach of a place.
template <class F>
void find_images(const StepContext& c, const VatMotion& motion, const CellSortedPoints& points,
                 const Vec3& place, Real reach, F&& f) {
  if (c.model.walls.empty()) return;
  for_each_image(c.model, motion, points, place, reach, f);
}

void find_liquid_images(const StepContext& c, const VatMotion& motion, Index self,
                        std::vector<KernelGradient>& found) {
  const CellSortedPoints& points = c.work.liquid;
  const LiquidModel& liquid = liquid_of(c.model, points.grid.order()[self]);
  find_images(c, motion, points, place_of(points, self), liquid.support_radius,
              [&](Index slot, const Vec3& x, const Mirror& mirror) {
                found.push_back({liquid.kernel.slope_over_r(x.norm()) * x, slot, mirror.axes});
              });
}

void find_solids(const StepContext& c, const VatMotion& motion, Index self,
                 std::vector<KernelGradient>& found) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const LiquidModel& liquid = liquid_of(c.model, c.work.liquid.grid.order()[self]);
  const PairBlock& near = c.work.solids_of_liquid[self / kBlockSize];
  const Vec3 place = place_of(c.work.liquid, self);
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const Vec3 x = nearest_image(c.model, place - place_of(solids, near.slots[k]));
    const Real r = x.norm();
    if (r >= liquid.support_radius) continue;
    found.push_back({liquid.kernel.slope_over_r(r) * x, near.slots[k]});
  }
  find_images(c, motion, solids, place, liquid.support_radius,
              [&](Index slot, const Vec3& x, const Mirror& mirror) {
                found.push_back({liquid.kernel.slope_over_r(x.norm()) * x, slot, mirror.axes});
              });
}

/// The same pairs from the other side.
void find_liquid(const StepContext& c, const VatMotion& motion, Index self, Real reach,
                 std::vector<KernelGradient>& found) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  const PairBlock& near = c.work.liquid_of_solids[self / kBlockSize];
  const Vec3 place = place_of(c.work.solids_in_liquid, self);
  const auto take = [&](Index slot, const Vec3& x, const std::array<bool, 3>& mirrored) {
    const LiquidModel& liquid = liquid_of(c.model, order[slot]);
    const Real r = x.norm();
    if (r >= liquid.support_radius) return;
    found.push_back({liquid.kernel.slope_over_r(r) * x, slot, mirrored});
  };
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const Index slot = near.slots[k];
    take(slot, -nearest_image(c.model, place_of(points, slot) - place), {});
  }
  find_images(c, motion, points, place, reach,
              [&](Index slot, const Vec3& x, const Mirror& mirror) { take(slot, x, mirror.axes); });
}

}  // namespace

void PressurePairs::build(const StepContext& c) {
  using Found = std::vector<KernelGradient>;
  const VatMotion motion = motion_of(c);
  fill_records(c, records);
  fill_slopes(c, *this);
  fill_blocks(c, records.size(), images,
              [&](Index self, Found& found) { find_liquid_images(c, motion, self, found); });
  if (!has_solids(c.model)) return;
  const std::span<const Index> order = c.work.solids_in_liquid.grid.order();
  solid_volume.resize(order.size());
  for (std::size_t s = 0; s < order.size(); ++s) {
    solid_volume[s] = c.model.rest_volume[c.model.liquid_count + order[s]];
  }
  const Real reach = support_of(c.model);
  fill_blocks(c, records.size(), solids,
              [&](Index self, Found& found) { find_solids(c, motion, self, found); });
  fill_blocks(c, order.size(), of_solids,
              [&](Index self, Found& found) { find_liquid(c, motion, self, reach, found); });
}

}  // namespace vat
