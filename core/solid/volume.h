#pragma once

#include "core/state/state.h"

namespace vat {

struct StepContext;

/// Stages of bodies with a bulk modulus. Each lattice cell has the energy K (V - V0)^2 / (2 V0),
/// and therefore the pressure K (1 - V / V0). The pressure acts on the corners of the cell along
/// the gradient of its volume. (M. Teschner, B. Heidelberger, M. Mueller, M. Gross, Computer
/// Graphics International 2004, pages 312-319, use tetrahedra as cells.) Translations and rotations
/// do not change the volume, so that the sum of the gradients is zero. Linear and angular momentum
/// are therefore conserved up to rounding.
void compute_cell_pressure(StepContext& context);
void add_cell_forces(StepContext& context);

/// Returns the energy of compressed and expanded cells [J].
Real cell_energy(const Model& model, const Configuration& configuration);

}  // namespace vat
