#include "core/forces/liquid.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <span>

#include "core/forces/pair_direction.h"
#include "core/limits.h"
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

/// Makes room for `wanted` slots; by quarters, since a vector by itself would double.
void make_room(std::vector<Index>& slots, std::size_t wanted) {
  if (slots.size() >= wanted) return;
  const std::size_t size = std::max(wanted, slots.size() + slots.size() / 4);
  slots.reserve(size);
  slots.resize(size);
}

/// Slots nearer to `place` than `support`, but `self`, appended to `found` from `count` on; the new
/// count. Every candidate is written and only a neighbour advances the count: no branch to
/// mispredict.
std::size_t find_near(const CellSortedPoints& points, const Vec3& place, Index self, Real support,
                      std::vector<Index>& found, std::size_t count) {
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
  c.work.liquid.build(points.first(c.model.liquid_count), greatest_support(c.model),
                      c.model.periodic);
}

namespace {

/// rho_i = sum_j m_j W(x_i - x_j, h), the particle itself included.                   Boldt eq. 10
template <bool periodic>
Real sum_density(const Model& model, const CellSortedPoints& points, Index self,
                 std::span<const Index> neighbours) {
  const std::span<const Index> order = points.grid.order();
  const Poly6& kernel = liquid_of(model, order[self]).density_kernel;
  Real density = model.mass[order[self]] * kernel.value(0);
  for (const Index slot : neighbours) {
    Real dx = points.x[slot] - points.x[self];
    Real dy = points.y[slot] - points.y[self];
    Real dz = points.z[slot] - points.z[self];
    if constexpr (periodic) {
      dx = model.periodic.nearest(dx, 0);
      dy = model.periodic.nearest(dy, 1);
      dz = model.periodic.nearest(dz, 2);
    }
    density += model.mass[order[slot]] * kernel.value(dx * dx + dy * dy + dz * dz);
  }
  return density;
}

/// Fills one block's pairs and densities. Once the blocks together have found more than `most`, the
/// rest get no neighbours.
template <bool periodic>
void fill_block(StepContext& c, std::size_t begin, std::size_t end,
                std::atomic<std::size_t>& pair_count, std::size_t most) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  PairBlock& pairs = c.work.liquid_pairs[begin / kBlockSize];
  std::size_t count = 0;
  for (std::size_t s = begin; s < end; ++s) {
    const auto self = static_cast<Index>(s);
    const std::size_t first = count;
    pairs.begin[s - begin] = static_cast<Index>(first);
    if (pair_count.load(std::memory_order_relaxed) <= most) {
      const Real support = liquid_of(c.model, order[self]).support_radius;
      count =
          find_neighbours<periodic>(c.model.periodic, points, self, support, pairs.slots, count);
      if (c.model.liquids_touch) {
        count = keep_material(c.model, order, self, pairs.slots, first, count);
      }
      pair_count.fetch_add(count - first, std::memory_order_relaxed);
    }
    c.work.density[order[self]] = sum_density<periodic>(
        c.model, points, self, std::span<const Index>(pairs.slots).subspan(first, count - first));
  }
  pairs.begin[end - begin] = static_cast<Index>(count);
}

}  // namespace

void compute_liquid_density(StepContext& c) {
  const std::size_t slots = c.work.liquid.grid.order().size();
  c.work.density.resize(c.model.liquid_count);
  c.work.liquid_pairs.resize((slots + kBlockSize - 1) / kBlockSize);
  const std::size_t most = max_pairs(c.model.liquid_count);
  std::atomic<std::size_t> pair_count = 0;
  for_blocks(c.runner, slots, [&](std::size_t begin, std::size_t end) {
    if (c.model.periodic.any()) {
      fill_block<true>(c, begin, end, pair_count, most);
    } else {
      fill_block<false>(c, begin, end, pair_count, most);
    }
  });
  c.work.too_many_pairs = pair_count > most;
  // One particle is enough for the guard to see; which blocks were cut off depends on threads.
  if (c.work.too_many_pairs) c.work.density[0] = std::numeric_limits<Real>::quiet_NaN();
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

template <LiquidTerms terms>
void fill_records(StepContext& c) {
  const CellSortedPoints& points = c.work.liquid;
  const std::span<const Index> order = points.grid.order();
  c.work.liquid_records.resize(order.size());
  if constexpr (terms.filled) c.work.filling.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = order[slot];
      LiquidRecord& record = c.work.liquid_records[slot];
      record.position = {points.x[slot], points.y[slot], points.z[slot]};
      record.volume = c.model.mass[i] / c.work.density[i];
      if constexpr (terms.viscosity) record.velocity = c.configuration.velocity[i];
      if constexpr (terms.pressure) record.pressure = c.work.pressure[i];
      if constexpr (terms.filled) {
        c.work.filling[slot] = c.work.density[i] / c.work.filled_density[i];
      }
    }
  });
}

// Pressure: -V_i V_j (p_i + p_j) grad W. Boldt and [MCG03] eq. 10 have half of it, which tends to
// half the pressure gradient in the bulk (there sum_j V_j grad W is near zero); Boldt also prints
// densities for the pressures and drops the sign.
// Viscosity: mu V_i V_j (v_j - v_i) laplacian W.                                  [MCG03] eq. 14
// Both are forces on particles: the papers' force densities times the particle's volume, which the
// caller multiplies by.
template <LiquidTerms terms>
inline Vec3 liquid_pair_force(const LiquidModel& liquid, const LiquidRecord& i,
                              const LiquidRecord& j, Real r, const Vec3& direction, Real filling) {
  Vec3 force = Vec3::Zero();
  if constexpr (terms.pressure) {
    force = -(i.pressure + j.pressure) * liquid.pressure_kernel.slope(r) * direction;
  }
  if constexpr (terms.viscosity) {
    Real strength = liquid.viscosity * liquid.viscosity_kernel.laplacian(r);
    if constexpr (terms.filled) strength *= filling;
    force += strength * (j.velocity - i.velocity);
  }
  return j.volume * force;
}

template <LiquidTerms terms, bool periodic>
void add_pair_forces(StepContext& c) {
  fill_records<terms>(c);
  const std::span<const Index> order = c.work.liquid.grid.order();
  const int dimensions = c.model.scene.dimensions;
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = c.work.liquid_pairs[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = c.work.liquid_records[s];
      const LiquidModel& liquid = liquid_of(c.model, order[s]);
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Index slot = pairs.slots[k];
        const LiquidRecord& other = c.work.liquid_records[slot];
        Vec3 x_ij = own.position - other.position;
        if constexpr (periodic) x_ij = c.model.periodic.nearest(x_ij);
        const Real r = x_ij.norm();
        const Vec3 direction = pair_direction(x_ij, r, order[s], order[slot], dimensions);
        Real filling = 1;
        if constexpr (terms.filled) filling = c.work.filling[s] * c.work.filling[slot];
        sum += liquid_pair_force<terms>(liquid, own, other, r, direction, filling);
      }
      c.forces.particle[order[s]] += own.volume * sum;
    }
  });
}

}  // namespace

template <LiquidTerms terms>
void add_liquid_forces(StepContext& c) {
  if (c.model.periodic.any()) {
    add_pair_forces<terms, true>(c);
  } else {
    add_pair_forces<terms, false>(c);
  }
}

template void add_liquid_forces<LiquidTerms{true, true, false}>(StepContext&);
template void add_liquid_forces<LiquidTerms{true, true, true}>(StepContext&);
template void add_liquid_forces<LiquidTerms{true, false, false}>(StepContext&);
template void add_liquid_forces<LiquidTerms{false, true, false}>(StepContext&);
template void add_liquid_forces<LiquidTerms{false, true, true}>(StepContext&);

}  // namespace vat
