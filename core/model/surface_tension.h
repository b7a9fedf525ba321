#pragma once

#include "core/model/model.h"

namespace vat {

/// Fills the data of surface tension if some liquid body has it. The model must have its bodies and
/// liquids.
void compile_surface_tension(Model& model);

}  // namespace vat
