#include <algorithm>

#include "core/forces/liquid_pairs.h"
#include "core/forces/weakly_compressible.h"
#include "core/forces/weakly_compressible_pairs.h"

// Solids in a weakly compressible liquid.

namespace vat {

void find_liquid_solids(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  const Index first = c.model.liquid_count;
  const Real support = support_of(c.model);
  c.work.solids_in_liquid.build(points.subspan(first), support, c.model.periodic);
  const auto find = [&](const CellSortedPoints& from, const CellSortedPoints& to,
                        std::vector<PairBlock>& blocks) {
    const std::size_t count = from.grid.order().size();
    blocks.resize(block_count(count));
    for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
      PairBlock& block = blocks[begin / kBlockSize];
      std::size_t found = 0;
      for (std::size_t s = begin; s < end; ++s) {
        block.begin[s - begin] = static_cast<Index>(found);
        const Vec3 place(from.x[s], from.y[s], from.z[s]);
        c.model.periodic.for_each_image(place, support, [&](const Vec3& shift) {
          found = find_near(to, place + shift, kNoParticle, support, block.slots, found);
        });
      }
      block.begin[end - begin] = static_cast<Index>(found);
    });
  };
  find(c.work.liquid, c.work.solids_in_liquid, c.work.solids_of_liquid);
  find(c.work.solids_in_liquid, c.work.liquid, c.work.liquid_of_solids);
}

namespace {

/// The mean pressure around a place, weighted with the kernel and extrapolated by the weight of
/// the liquid between.
class Extrapolation {
 public:
  Extrapolation(const Model& model, const Vec3& place)
      : fall_(fall_in_vat(model, {}, place)), may_pull_(model.is_filled) {}

  /// x leads from the liquid to the place.
  void add(const LiquidModel& liquid, Real pressure, const Vec3& x) {
    const Real r = x.norm();
    if (r >= liquid.support_radius) return;
    const Real w = liquid.kernel.value(r);
    weight_ += w;
    sum_ += w * (pressure + liquid.rest_density * fall_.dot(x));
  }

  Real pressure() const {
    if (!(weight_ > 0)) return 0;
    const Real mean = sum_ / weight_;
    return may_pull_ ? mean : std::max(Real{0}, mean);
  }

 private:
  Vec3 fall_;
  bool may_pull_;
  Real weight_ = 0;
  Real sum_ = 0;
};

/// Of solid slot `self`, over liquid and the walls' images of it.
Real extrapolated_pressure(const StepContext& c, Index self, Real support,
                           const VatMotion& motion) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  const Vec3 place(solids.x[self], solids.y[self], solids.z[self]);
  const PairBlock& near = c.work.liquid_of_solids[self / kBlockSize];
  Extrapolation sum(c.model, place);
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const Index slot = near.slots[k];
    const Vec3 x =
        nearest_image(c.model, place - Vec3(points.x[slot], points.y[slot], points.z[slot]));
    sum.add(liquid_of(c.model, order[slot]), c.work.pressure[order[slot]], x);
  }
  if (c.model.walls.empty()) return sum.pressure();
  const ImagePressure image_pressure(c.model, motion, place);
  for_each_image(
      c.model, motion, points, place, support,
      [&](Index slot, const Vec3& x, const Mirror& mirror) {
        const LiquidModel& liquid = liquid_of(c.model, order[slot]);
        const Vec3 position(points.x[slot], points.y[slot], points.z[slot]);
        sum.add(liquid, image_pressure(liquid, c.work.pressure[order[slot]], position, mirror), x);
      });
  return sum.pressure();
}

}  // namespace

void extrapolate_pressure(StepContext& c) {
  const std::size_t count = c.work.solids_in_liquid.grid.order().size();
  const VatMotion motion = motion_of(c);
  const Real support = support_of(c.model);
  c.work.solid_pressure.resize(count);
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      c.work.solid_pressure[s] = extrapolated_pressure(c, static_cast<Index>(s), support, motion);
    }
  });
}

namespace {

/// On solid slot `self`, over its volume, by the liquid near it.
Vec3 liquid_forces(const StepContext& c, Index self, const Vec3& place) {
  const PairBlock& near = c.work.liquid_of_solids[self / kBlockSize];
  const Real pressure = c.work.solid_pressure[self];
  const Vec3& velocity =
      c.configuration.velocity[c.model.liquid_count + c.work.solids_in_liquid.grid.order()[self]];
  Vec3 sum = Vec3::Zero();
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const LiquidRecord& other = c.work.liquid_records[near.slots[k]];
    const LiquidModel& liquid = liquid_of(c.model, c.work.liquid.grid.order()[near.slots[k]]);
    const Vec3 x = nearest_image(c.model, other.position - place);
    const Real r = x.norm();
    if (r >= liquid.support_radius) continue;
    sum -= other.volume *
           central_force(liquid, liquid.central_viscosity, other.pressure + pressure,
                         other.velocity - velocity, x, r) *
           x;
  }
  return sum;
}

/// The same by the walls' images of liquid.
Vec3 image_forces(const StepContext& c, Index self, const Vec3& place, Real support,
                  const VatMotion& motion) {
  const std::span<const Index> order = c.work.liquid.grid.order();
  const Real pressure = c.work.solid_pressure[self];
  const ImagePressure image_pressure(c.model, motion, place);
  Vec3 sum = Vec3::Zero();
  for_each_image(c.model, motion, c.work.liquid, place, support,
                 [&](Index slot, const Vec3& x, const Mirror& mirror) {
                   const LiquidRecord& other = c.work.liquid_records[slot];
                   const LiquidModel& liquid = liquid_of(c.model, order[slot]);
                   const Real both =
                       pressure + image_pressure(liquid, other.pressure, other.position, mirror);
                   sum += (other.volume * pressure_force(liquid, both, x.norm())) * x;
                 });
  return sum;
}

}  // namespace

void add_tait_forces_on_solids(StepContext& c) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const std::span<const Index> order = solids.grid.order();
  const VatMotion motion = motion_of(c);
  const Real support = support_of(c.model);
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto self = static_cast<Index>(s);
      const Vec3 place(solids.x[s], solids.y[s], solids.z[s]);
      Vec3 sum = liquid_forces(c, self, place);
      if (!c.model.walls.empty()) sum += image_forces(c, self, place, support, motion);
      const Index b = c.model.liquid_count + order[s];
      c.forces.particle[b] += c.model.rest_volume[b] * sum;
    }
  });
}

}  // namespace vat
