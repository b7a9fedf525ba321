#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/support/names.h"
#include "core/support/result.h"

namespace vat {

/// Instruction set of the vectorised loops. Results are bitwise equal for the same set, and differ
/// between sets by rounding.
enum class InstructionSet : std::uint8_t {
  baseline,  ///< available on all processors of the architecture: SSE2 on x86-64
  avx2,      ///< AVX2, FMA, BMI, BMI2, LZCNT and F16C
  avx512,    ///< avx2, and AVX-512 F, CD, BW, DQ and VL
};

template <>
inline constexpr std::array kNamesOf<InstructionSet>{"baseline", "avx2", "avx512"};

/// Returns the set with this name. Fails for an unknown name, with a list of the names.
Result<InstructionSet> parse_instruction_set(std::string_view name);

/// Returns the sets that this build contains and this machine supports, in ascending order. The
/// first set is baseline.
std::vector<InstructionSet> available_instruction_sets();
/// Returns the highest available set.
InstructionSet best_instruction_set();
/// Fails with the code "not_available" and a list of the available sets if `set` is not available.
Status check_available(InstructionSet set);

/// Hides the sets above `greatest` in all threads from now on. Used to test machines with fewer
/// instructions.
void limit_instruction_sets(InstructionSet greatest);

}  // namespace vat
