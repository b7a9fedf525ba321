#pragma once

namespace vat {

struct StepContext;

/// Stage: cell order of the liquid particles.
void sort_liquid(StepContext& context);

/// Stage: density by summation, Boldt eq. 10 with poly6; keeps the neighbours found. Where a
/// collapsed liquid has more than max_pairs() of them, says so in the workspace and leaves a
/// density that is not a number, so that the step fails.
void compute_liquid_density(StepContext& context);

/// Stage: p = k (rho - rho_0), Boldt eq. 14, and never below zero: a free surface lacks neighbours,
/// and the pull of a negative pressure there makes particles clump.
void compute_liquid_pressure(StepContext& context);

/// Which forces a liquid has. Chosen when a scene is compiled: pairs do not ask.
struct LiquidTerms {
  bool pressure = true;
  bool viscosity = true;
  /// Viscosity counts volumes by the filled density: beside a wall that drags the liquid along, the
  /// summed one lacks what is beyond the wall.
  bool filled = false;
};

/// Stage: pressure force and viscosity, as forces on particles.
template <LiquidTerms terms>
void add_liquid_forces(StepContext& context);

}  // namespace vat
