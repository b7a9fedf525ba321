#pragma once

#include "core/model/model.h"

namespace vat {

/// Adds the static springs of deformable bodies. The model must have its bodies and particles.
void add_springs(Model& model);

/// Adds the cells of deformable bodies with a bulk modulus.
void add_cells(Model& model);

/// Finds the springs with a maximum length, and colours them. Each gets the first colour that no
/// other spring of its particles has. The model must have its springs.
void find_limited_springs(Model& model);

}  // namespace vat
