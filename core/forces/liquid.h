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

/// Stage: pressure force, and viscosity where asked for, as forces on particles.
template <bool viscous>
void add_liquid_forces(StepContext& context);

}  // namespace vat
