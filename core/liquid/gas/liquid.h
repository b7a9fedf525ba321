#pragma once

namespace vat {

struct StepContext;

/// Stage: sorts the liquid particles into cells.
void sort_liquid(StepContext& context);

/// Stage: computes the density by summation, Boldt eq. 10 with poly6, and stores the neighbours. If
/// a collapsed liquid has more than max_pairs(), sets too_many_pairs and one density to NaN, so
/// that the step fails.
void compute_liquid_density(StepContext& context);

/// Stage: p = k (rho - rho_0), Boldt eq. 14, at least zero. A free surface has few neighbours, and
/// particles with a negative pressure there would form clumps.
void compute_liquid_pressure(StepContext& context);

/// The forces of a liquid, chosen when a scene is compiled, so that loops over pairs have no
/// conditions.
struct LiquidTerms {
  bool pressure = true;
  bool viscosity = true;
  /// Viscosity uses volumes of the filled density: at a no-slip wall, the summed density does not
  /// include the liquid beyond the wall.
  bool filled = false;
};

/// Stage: pressure force and viscosity, as forces on particles.
template <LiquidTerms terms>
void add_liquid_forces(StepContext& context);

}  // namespace vat
