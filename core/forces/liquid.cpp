#include "core/forces/liquid.h"

#include <algorithm>
#include <cmath>

#include "core/forces/pair_direction.h"
#include "core/step/workspace.h"

namespace vat {
namespace {

const LiquidModel& liquid_of(const Model& model, Index particle) {
  return *model.liquids[model.material[particle]];
}

Real greatest_support(const Model& model) {
  Real support = 0;
  for (const ModelBody& body : model.bodies) {
    if (body.kind == BodyKind::liquid) {
      support = std::max(support, model.liquids[body.material]->support_radius);
    }
  }
  return support;
}

/// Slots nearer to slot `self` than `support`, appended to `found` from `count` on; the new count.
/// Every candidate is written and only a neighbour advances the count: no branch to mispredict.
std::size_t find_neighbours(const CellSortedPoints& points, Index self, Real support,
                            std::vector<Index>& found, std::size_t count) {
  const Real x = points.x[self];
  const Real y = points.y[self];
  const Real z = points.z[self];
  const Real support2 = support * support;
  points.grid.for_each_run({x, y, z}, support, [&](Index begin, Index end) {
    if (found.size() < count + (end - begin)) found.resize(2 * count + (end - begin));
    Index* const out = found.data();
    for (Index slot = begin; slot < end; ++slot) {
      const Real dx = points.x[slot] - x;
      const Real dy = points.y[slot] - y;
      const Real dz = points.z[slot] - z;
      out[count] = slot;
      count += static_cast<std::size_t>((dx * dx + dy * dy + dz * dz < support2) & (slot != self));
    }
  });
  return count;
}

/// Keeps of found[first, count) the slots of the same material as slot `self`.
std::size_t keep_material(const Model& model, std::span<const Index> order, Index self,
                          std::vector<Index>& found, std::size_t first, std::size_t count) {
  const Index material = model.material[order[self]];
  const auto begin = found.begin();
  const auto kept = std::remove_if(
      begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(count),
      [&](Index slot) { return model.material[order[slot]] != material; });
  return static_cast<std::size_t>(kept - begin);
}

}  // namespace

void sort_liquid(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  c.work.liquid.build(points.first(c.model.liquid_count), greatest_support(c.model));
}

void compute_liquid_density(StepContext& c) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  c.work.density.resize(c.model.liquid_count);
  c.work.liquid_pairs.resize((order.size() + kBlockSize - 1) / kBlockSize);
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    PairBlock& pairs = c.work.liquid_pairs[begin / kBlockSize];
    std::size_t count = 0;
    for (std::size_t s = begin; s < end; ++s) {
      const auto self = static_cast<Index>(s);
      const Index i = order[self];
      const LiquidModel& liquid = liquid_of(c.model, i);
      const std::size_t first = count;
      pairs.begin[s - begin] = static_cast<Index>(first);
      count = find_neighbours(points, self, liquid.support_radius, pairs.slots, count);
      if (c.model.liquids_touch) {
        count = keep_material(c.model, order, self, pairs.slots, first, count);
      }
      // rho_i = sum_j m_j W(x_i - x_j, h), the particle itself included.           Boldt eq. 10
      Real density = c.model.mass[i] * liquid.density_kernel.value(0);
      for (std::size_t k = first; k < count; ++k) {
        const Index slot = pairs.slots[k];
        const Real dx = points.x[slot] - points.x[self];
        const Real dy = points.y[slot] - points.y[self];
        const Real dz = points.z[slot] - points.z[self];
        density +=
            c.model.mass[order[slot]] * liquid.density_kernel.value(dx * dx + dy * dy + dz * dz);
      }
      c.work.density[i] = density;
    }
    pairs.begin[end - begin] = static_cast<Index>(count);
  });
}

void compute_liquid_pressure(StepContext& c) {
  c.work.pressure.resize(c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, static_cast<Index>(i));
      c.work.pressure[i] =
          std::max(Real{0}, liquid.stiffness * (c.work.density[i] - liquid.rest_density));
    }
  });
}

namespace {

void fill_records(StepContext& c) {
  const std::span<const Index> order = c.work.liquid.grid.order();
  c.work.liquid_records.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = order[slot];
      c.work.liquid_records[slot] = {c.configuration.position[i],
                                     c.model.mass[i] / c.work.density[i],
                                     c.configuration.velocity[i], c.work.pressure[i]};
    }
  });
}

// Pressure: -V_i V_j (p_i + p_j) grad W. Boldt and [MCG03] eq. 10 have half of it, which tends to
// half the pressure gradient in the bulk (there sum_j V_j grad W is near zero); Boldt also prints
// densities for the pressures and drops the sign.
// Viscosity: mu V_i V_j (v_j - v_i) laplacian W.                                  [MCG03] eq. 14
// Both are forces on particles: the papers' force densities times the particle's volume.
template <bool viscous>
Vec3 liquid_pair_force(const LiquidModel& liquid, const LiquidRecord& i, const LiquidRecord& j,
                       Real r, const Vec3& direction) {
  Vec3 force = -(i.pressure + j.pressure) * liquid.pressure_kernel.slope(r) * direction;
  if constexpr (viscous) {
    force += liquid.viscosity * liquid.viscosity_kernel.laplacian(r) * (j.velocity - i.velocity);
  }
  return j.volume * force;
}

}  // namespace

template <bool viscous>
void add_liquid_forces(StepContext& c) {
  fill_records(c);
  const std::span<const Index> order = c.work.liquid.grid.order();
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = c.work.liquid_pairs[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = c.work.liquid_records[s];
      const LiquidModel& liquid = liquid_of(c.model, order[s]);
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Index slot = pairs.slots[k];
        const LiquidRecord& other = c.work.liquid_records[slot];
        const Vec3 x_ij = own.position - other.position;
        const Real r = x_ij.norm();
        const Vec3 direction = pair_direction(x_ij, r, order[s], order[slot]);
        sum += liquid_pair_force<viscous>(liquid, own, other, r, direction);
      }
      c.forces.particle[order[s]] += own.volume * sum;
    }
  });
}

template void add_liquid_forces<true>(StepContext&);
template void add_liquid_forces<false>(StepContext&);

}  // namespace vat
