#pragma once

#include "core/support/instruction_set.h"

namespace vat {

/// Hides the sets above `greatest` in all threads from now on. For tests of machines with fewer
/// instructions.
void limit_instruction_sets(InstructionSet greatest);

}  // namespace vat
