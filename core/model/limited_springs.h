#pragma once

#include "core/model/model.h"

namespace vat {

/// Finds the springs with a greatest length, and colours them: in turn each gets the first colour
/// that no other spring of its two particles has.
void find_limited_springs(Model& model);

}  // namespace vat
