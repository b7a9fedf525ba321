#pragma once

#include "core/types.h"

namespace vat {

struct Model;
struct StepContext;

/// Returns the greatest support radius of the liquids of a model [m].
Real greatest_support(const Model& model);

/// Stage that sorts the liquid particles into cells.
void sort_liquid(StepContext& context);

/// Stage that computes the density by summation (Boldt eq. 10 with the kernel Poly6), and stores
/// the neighbours. If a collapsed liquid has more than max_pairs() pairs, the stage sets
/// too_many_pairs to true and one density to NaN, so that the step fails.
void compute_liquid_density(StepContext& context);

/// Stage that sets the pressure to max(0, k (rho - rho_0)) (Boldt eq. 14). The summed density is
/// low at a free surface, and negative pressures would cause clumps of particles there.
void compute_liquid_pressure(StepContext& context);

/// The force terms of a liquid. Terms are template arguments, so that loops over pairs contain no
/// conditions.
struct LiquidTerms {
  bool pressure = true;
  bool viscosity = true;
  /// Whether viscosity uses the particle volumes m / LiquidScratch::filled_density. At a no-slip
  /// wall, the summed density does not include the liquid beyond the wall.
  bool filled = false;
};

/// Stage that adds the pressure and viscosity forces on particles.
template <LiquidTerms terms>
void add_liquid_forces(StepContext& context);

}  // namespace vat
