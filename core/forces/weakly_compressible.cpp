#include "core/forces/weakly_compressible.h"

#include <algorithm>

#include "core/forces/liquid_pairs.h"
#include "core/forces/weakly_compressible_pairs.h"

namespace vat {
namespace {

bool has_several_liquids(const Model& model) {
  const auto liquids = std::span(model.material).first(model.liquid_count);
  return std::ranges::any_of(liquids, [&](Index material) { return material != liquids[0]; });
}

/// s_i over liquid and solids, the particle itself included.
template <bool periodic>
Real sum_volumes(const StepContext& c, Index self, std::span<const Index> neighbours) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  const SmoothingKernel& kernel = liquid_of(c.model, order[self]).kernel;
  const Vec3 place(points.x[self], points.y[self], points.z[self]);
  Real sum = c.model.rest_volume[order[self]] * kernel.value(0);
  for (const Index slot : neighbours) {
    Vec3 x(points.x[slot] - place.x(), points.y[slot] - place.y(), points.z[slot] - place.z());
    if constexpr (periodic) x = c.model.periodic.nearest(x);
    sum += c.model.rest_volume[order[slot]] * kernel.value(x.norm());
  }
  return sum;
}

Real sum_solid_volumes(const StepContext& c, Index self, const LiquidModel& liquid) {
  const CellSortedPoints& points = c.work.liquid;
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const PairBlock& near = c.work.solids_of_liquid[self / kBlockSize];
  const Vec3 place(points.x[self], points.y[self], points.z[self]);
  Real sum = 0;
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const Index slot = near.slots[k];
    const Vec3 x =
        nearest_image(c.model, place - Vec3(solids.x[slot], solids.y[slot], solids.z[slot]));
    const Real r = x.norm();
    if (r >= liquid.support_radius) continue;
    sum += c.model.rest_volume[c.model.liquid_count + solids.grid.order()[slot]] *
           liquid.kernel.value(r);
  }
  return sum;
}

/// What the walls' images add to s_i. A particle and its own images, up to seven in a corner, do
/// not count for more than liquid at rest: alone they have no pressure, and the mirror turns back
/// what flies into a corner as it does at a face. By their pressure they would be on a spring of up
/// to six times c / h, where a step allows for half of that.
Real sum_mirrored_volumes(const StepContext& c, Index self, const LiquidModel& liquid,
                          const VatMotion& motion) {
  const CellSortedPoints& points = c.work.liquid;
  const Vec3 place(points.x[self], points.y[self], points.z[self]);
  const auto share = [&](Index slot, Real r) {
    return c.model.rest_volume[points.grid.order()[slot]] * liquid.kernel.value(r);
  };
  Real sum = 0;
  Real own = share(self, 0);
  for_each_image(c.model, motion, points, place, liquid.support_radius,
                 [&](Index slot, const Vec3& x, const Mirror&) {
                   const Real part = share(slot, x.norm());
                   sum += part;
                   if (slot == self) own += part;
                 });
  sum -= std::max(Real{0}, own - 1);
  if (!has_solids(c.model)) return sum;
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  for_each_image(c.model, motion, solids, place, liquid.support_radius,
                 [&](Index slot, const Vec3& x, const Mirror&) {
                   sum += c.model.rest_volume[c.model.liquid_count + solids.grid.order()[slot]] *
                          liquid.kernel.value(x.norm());
                 });
  return sum;
}

template <bool periodic>
void compute_density(StepContext& c) {
  const VatMotion motion = motion_of(c);
  const bool solids = has_solids(c.model);
  find_pairs<periodic>(c, [&](Index slot, std::span<const Index> neighbours) {
    const Index i = c.work.liquid.grid.order()[slot];
    const LiquidModel& liquid = liquid_of(c.model, i);
    Real sum = sum_volumes<periodic>(c, slot, neighbours);
    if (solids) sum += sum_solid_volumes(c, slot, liquid);
    if (!c.model.walls.empty()) {
      sum += sum_mirrored_volumes(c, slot, liquid, motion);
    }
    return liquid.rest_density * sum;
  });
}

}  // namespace

void compute_tait_density(StepContext& c) {
  c.model.periodic.any() ? compute_density<true>(c) : compute_density<false>(c);
}

void compute_tait_pressure(StepContext& c) {
  c.work.pressure.resize(c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, i);
      const Real s = c.work.density[i] / liquid.rest_density;
      const Real pressure = liquid.rest_density * liquid.stiffness * tait_pressure(s);
      c.work.pressure[i] =
          c.model.is_filled ? pressure : std::max(least_pressure(liquid, s), pressure);
    }
  });
}

namespace {

/// p / s^2 of liquid particle i.
Real pressure_term(const StepContext& c, Index i) {
  const Real s = c.work.density[i] / liquid_of(c.model, i).rest_density;
  return c.work.pressure[i] / (s * s);
}

void fill_tait_records(StepContext& c) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  c.work.liquid_records.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = order[slot];
      c.work.liquid_records[slot] = {{points.x[slot], points.y[slot], points.z[slot]},
                                     c.model.rest_volume[i],
                                     c.configuration.velocity[i],
                                     pressure_term(c, i)};
    }
  });
}

/// On one liquid particle, over its volume.
Vec3 solid_forces(const StepContext& c, const LiquidModel& liquid, Index self,
                  const LiquidRecord& own) {
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  const PairBlock& near = c.work.solids_of_liquid[self / kBlockSize];
  Vec3 sum = Vec3::Zero();
  for (Index k = near.begin[self % kBlockSize]; k < near.begin[self % kBlockSize + 1]; ++k) {
    const Index slot = near.slots[k];
    const Index b = c.model.liquid_count + solids.grid.order()[slot];
    const Vec3 x =
        nearest_image(c.model, own.position - Vec3(solids.x[slot], solids.y[slot], solids.z[slot]));
    const Real r = x.norm();
    if (r >= liquid.support_radius) continue;
    sum +=
        c.model.rest_volume[b] *
        central_force(liquid, liquid.central_viscosity, own.pressure + c.work.solid_pressure[slot],
                      own.velocity - c.configuration.velocity[b], x, r) *
        x;
  }
  return sum;
}

/// On one liquid particle, over its volume: what the images of liquid and solids do to it.
Vec3 wall_forces(const StepContext& c, const LiquidModel& liquid, const VatMotion& motion,
                 Index self) {
  const LiquidRecord& own = c.work.liquid_records[self];
  const ImagePressure image_pressure(c.model, motion, own.position);
  Vec3 sum = Vec3::Zero();
  for_each_image(
      c.model, motion, c.work.liquid, own.position, liquid.support_radius,
      [&](Index slot, const Vec3& x, const Mirror& mirror) {
        const LiquidRecord& other = c.work.liquid_records[slot];
        const Real pressure = image_pressure(liquid, other.pressure, other.position, mirror);
        sum += (other.volume * pressure_force(liquid, own.pressure + pressure, x.norm())) * x;
      });
  if (!has_solids(c.model)) return sum;
  const CellSortedPoints& solids = c.work.solids_in_liquid;
  for_each_image(
      c.model, motion, solids, own.position, liquid.support_radius,
      [&](Index slot, const Vec3& x, const Mirror& mirror) {
        const Vec3 place(solids.x[slot], solids.y[slot], solids.z[slot]);
        const Real pressure = image_pressure(liquid, c.work.solid_pressure[slot], place, mirror);
        const Real volume = c.model.rest_volume[c.model.liquid_count + solids.grid.order()[slot]];
        sum += (volume * pressure_force(liquid, own.pressure + pressure, x.norm())) * x;
      });
  return sum;
}

template <bool periodic>
void add_pair_forces(StepContext& c) {
  fill_tait_records(c);
  const std::span<const Index> order = c.work.liquid.grid.order();
  const VatMotion motion = motion_of(c);
  const bool solids = has_solids(c.model);
  const bool several = has_several_liquids(c.model);
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = c.work.liquid_pairs[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = c.work.liquid_records[s];
      const LiquidModel& liquid = liquid_of(c.model, order[s]);
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const LiquidRecord& other = c.work.liquid_records[pairs.slots[k]];
        Vec3 x = own.position - other.position;
        if constexpr (periodic) x = c.model.periodic.nearest(x);
        const Real viscosity =
            several ? mean_viscosity(liquid, liquid_of(c.model, order[pairs.slots[k]]))
                    : liquid.central_viscosity;
        sum += other.volume *
               central_force(liquid, viscosity, own.pressure + other.pressure,
                             own.velocity - other.velocity, x, x.norm()) *
               x;
      }
      if (solids) sum += solid_forces(c, liquid, static_cast<Index>(s), own);
      if (!c.model.walls.empty()) {
        sum += wall_forces(c, liquid, motion, static_cast<Index>(s));
      }
      c.forces.particle[order[s]] += own.volume * sum;
    }
  });
}

}  // namespace

void add_tait_forces(StepContext& c) {
  c.model.periodic.any() ? add_pair_forces<true>(c) : add_pair_forces<false>(c);
}

}  // namespace vat
