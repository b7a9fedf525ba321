#pragma once

#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stages of bodies that keep their volume. Each cell of the lattice has the energy
/// K (V - V0)^2 / (2 V0), so a pressure K (1 - V / V0) that pushes its corners along the slope of
/// its volume (M. Teschner, B. Heidelberger, M. Mueller, M. Gross, Computer Graphics International
/// 2004, pages 312-319, whose cells are tetrahedra). The slopes of a volume that neither moving nor
/// turning a cell changes add up to nothing: linear and angular momentum stay to rounding.
void compute_cell_pressure(StepContext& context);
void add_cell_forces(StepContext& context);

/// The energy [J] in compressed and dilated cells.
Real cell_energy(const Model& model, const Configuration& configuration);

}  // namespace vat
