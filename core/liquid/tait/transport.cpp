#include "core/liquid/tait/transport.h"
#include "core/liquid/pairs/scratch.h"

#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Calls f(volume, gradient of W, slot, mirror) for all sources near liquid slot `self`: other
/// liquid, without a mirror; its images; and solids and their images, with the slot kNoParticle.
template <class F>
void for_each_near(const StepContext& c, const VatMotion& motion, Index self, F&& f) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const CellSortedPoints& points = buffers.liquid;
  const CellSortedPoints& solids = buffers.solids_in_liquid;
  const LiquidModel& liquid = liquid_of(c.model, points.grid.order()[self]);
  const Vec3& place = buffers.liquid_records[self].position;
  const auto visit = [&](Real volume, const Vec3& x, Index slot, const Mirror* mirror) {
    const Real r = x.norm();
    if (r >= liquid.support_radius) return;
    f(volume, Vec3(liquid.slope_scale * liquid.kernel.slope_over_r(r) * x), slot, mirror);
  };
  const auto solid_volume = [&](Index slot) {
    return c.model.rest_volume[c.model.liquid_count + solids.grid.order()[slot]];
  };
  const PairBlock& pairs = buffers.liquid_pairs[self / kBlockSize];
  const std::size_t k = self % kBlockSize;
  for (Index p = pairs.begin[k]; p < pairs.begin[k + 1]; ++p) {
    const LiquidRecord& other = buffers.liquid_records[pairs.slots[p]];
    visit(other.volume, nearest_image(c.model, place - other.position), pairs.slots[p], nullptr);
  }
  if (has_solids(c.model)) {
    const PairBlock& near = buffers.solids_of_liquid[self / kBlockSize];
    for (Index p = near.begin[k]; p < near.begin[k + 1]; ++p) {
      const Index slot = near.slots[p];
      const Vec3 position(solids.x[slot], solids.y[slot], solids.z[slot]);
      visit(solid_volume(slot), nearest_image(c.model, place - position), kNoParticle, nullptr);
    }
  }
  if (c.model.walls.empty()) return;
  for_each_image(c.model, motion, points, place, liquid.support_radius,
                 [&](Index slot, const Vec3& x, const Mirror& mirror) {
                   visit(buffers.liquid_records[slot].volume, x, slot, &mirror);
                 });
  if (!has_solids(c.model)) return;
  for_each_image(c.model, motion, solids, place, liquid.support_radius,
                 [&](Index slot, const Vec3& x, const Mirror& mirror) {
                   visit(solid_volume(slot), x, kNoParticle, &mirror);
                 });
}

/// Calls f(slot) for each liquid slot, in blocks.
template <class F>
void for_each_slot(const StepContext& c, F&& f) {
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) f(static_cast<Index>(s));
  });
}

}  // namespace

void compute_transport_velocity(StepContext& c) {
  const std::span<const Index> order = c.work.of<LiquidScratch>().liquid.grid.order();
  const VatMotion motion = motion_of(c);
  VAT_CHECK(order.size() == c.model.liquid_count);
  c.forces.transport.resize(c.model.liquid_count);
  for_each_slot(c, [&](Index s) {
    const LiquidModel& liquid = liquid_of(c.model, order[s]);
    Vec3 sum = Vec3::Zero();
    for_each_near(c, motion, s, [&](Real volume, const Vec3& gradient, Index, const Mirror*) {
      sum += volume * gradient;
    });
    c.forces.transport[order[s]] = -(std::sqrt(liquid.stiffness) * liquid.spacing / 6) * sum;
  });
}

void add_transport_forces(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const std::span<const Index> order = buffers.liquid.grid.order();
  VAT_CHECK(c.forces.transport.size() == c.model.liquid_count);
  const VatMotion motion = motion_of(c);
  const std::vector<Vec3>& transport = c.forces.transport;
  for_each_slot(c, [&](Index s) {
    const LiquidRecord& own = buffers.liquid_records[s];
    const Vec3& velocity = c.configuration.velocity[order[s]];
    const Vec3& w = transport[order[s]];
    Vec3 sum = Vec3::Zero();
    for_each_near(
        c, motion, s, [&](Real volume, const Vec3& gradient, Index slot, const Mirror* mirror) {
          Vec3 flow = w.dot(gradient) * velocity;
          if (slot != kNoParticle) {
            const Vec3& u_j = c.configuration.velocity[order[slot]];
            const Vec3& w_j = transport[order[slot]];
            flow += mirror == nullptr ? Vec3(w_j.dot(gradient) * u_j)
                                      : Vec3(mirror->turn(w_j).dot(gradient) * mirror->turn(u_j));
          }
          sum += volume * flow;
        });
    const Real density = liquid_of(c.model, order[s]).rest_density;
    c.forces.particle[order[s]] += own.volume * density * sum;
  });
}

}  // namespace vat
