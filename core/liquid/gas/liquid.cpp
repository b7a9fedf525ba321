#include "core/liquid/gas/liquid.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <span>

#include "core/laws/pair_direction.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {

Real greatest_support(const Model& model) {
  Real support = 0;
  for (const ModelBody& body : model.bodies) {
    if (body.kind == BodyKind::liquid) {
      support = std::max(support, model.liquids[body.material]->support_radius);
    }
  }
  return support;
}

void sort_liquid(StepContext& c) {
  const std::span<const Vec3> points(c.configuration.position);
  const Real cell_size = c.model.is_coupled ? pair_cell_size(c.model) : greatest_support(c.model);
  c.work.of<LiquidScratch>().liquid.update(points.first(c.model.liquid_count), cell_size,
                                           c.model.periodic, c.runner);
}

namespace {

/// rho_i = sum_j m_j W(x_i - x_j, h), including the particle itself.                  Boldt eq. 10
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

template <bool periodic>
void compute_density(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  VAT_CHECK(c.configuration.position.size() >= c.model.liquid_count);
  const std::span<const Index> order = buffers.liquid.grid.order();
  find_pairs<periodic>(c.model, c.work, c.runner,
                       [&](Index slot, std::span<const Index> neighbours) {
                         buffers.density[order[slot]] =
                             sum_density<periodic>(c.model, buffers.liquid, slot, neighbours);
                       });
}

}  // namespace

void compute_liquid_density(StepContext& c) {
  c.model.periodic.any() ? compute_density<true>(c) : compute_density<false>(c);
}

void compute_liquid_pressure(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  buffers.pressure.resize(c.model.liquid_count);
  VAT_CHECK(buffers.density.size() == c.model.liquid_count);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiquidModel& liquid = liquid_of(c.model, static_cast<Index>(i));
      buffers.pressure[i] =
          std::max(Real{0}, liquid.stiffness * (buffers.density[i] - liquid.rest_density));
    }
  });
}

namespace {

template <LiquidTerms terms>
void fill_records(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const CellSortedPoints& points = buffers.liquid;
  const std::span<const Index> order = points.grid.order();
  buffers.liquid_records.resize(order.size());
  if constexpr (terms.filled) buffers.filling.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = order[slot];
      LiquidRecord& record = buffers.liquid_records[slot];
      record.position = {points.x[slot], points.y[slot], points.z[slot]};
      record.volume = c.model.mass[i] / buffers.density[i];
      if constexpr (terms.viscosity) record.velocity = c.configuration.velocity[i];
      if constexpr (terms.pressure)
        record.pressure = liquid_of(c.model, i).pressure_share * buffers.pressure[i];
      if constexpr (terms.filled) {
        buffers.filling[slot] = buffers.density[i] / buffers.filled_density[i];
      }
    }
  });
}

// Pressure: -V_i V_j (p_i + p_j) grad W. Boldt and [MCG03] eq. 10 have half of it (pressure_share),
// which converges to half of the pressure gradient (in the interior, sum_j V_j grad W is near
// zero). Boldt also prints densities for pressures and omits the sign, which attracts.
// Viscosity: mu V_i V_j (v_j - v_i) laplacian W.                                  [MCG03] eq. 14
// Both are forces on particles: the force densities of the papers times the volume of the particle,
// by which the caller multiplies.
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
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  fill_records<terms>(c);
  const std::span<const Index> order = buffers.liquid.grid.order();
  const int dimensions = c.model.scene.dimensions;
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = buffers.liquid_pairs[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = buffers.liquid_records[s];
      const LiquidModel& liquid = liquid_of(c.model, order[s]);
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Index slot = pairs.slots[k];
        const LiquidRecord& other = buffers.liquid_records[slot];
        Vec3 x_ij = own.position - other.position;
        if constexpr (periodic) x_ij = c.model.periodic.nearest(x_ij);
        const Real r = x_ij.norm();
        const Vec3 direction = pair_direction(x_ij, r, order[s], order[slot], dimensions);
        Real filling = 1;
        if constexpr (terms.filled) filling = buffers.filling[s] * buffers.filling[slot];
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
