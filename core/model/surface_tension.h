#pragma once

#include "core/model/model.h"

namespace vat {

/// Fills what surface tension needs if some liquid body has surface tension. The model must have
/// its bodies and liquids.
void compile_surface_tension(Model& model);

}  // namespace vat
