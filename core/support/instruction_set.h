#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace vat {

/// Which instructions the vectorised loops use. Results are the same bits wherever the same set is
/// used, and differ in their last digits between sets.
enum class InstructionSet : std::uint8_t {
  baseline,  ///< what every processor of the architecture has: SSE2 on x86-64
  avx2,      ///< AVX2, FMA, BMI, BMI2, LZCNT and F16C
  avx512,    ///< those and AVX-512 F, CD, BW, DQ, VL
};

const char* to_string(InstructionSet set);
/// Fails for an unknown name, and says which there are.
Result<InstructionSet> parse_instruction_set(std::string_view name);

/// Those that this build has code for, and that the processor and the operating system can run, in
/// rising order; baseline is always the first.
std::vector<InstructionSet> available_instruction_sets();
/// The last of these.
InstructionSet best_instruction_set();
/// Fails with the code "not_available" for one that is not among them, and says which are.
Status check_available(InstructionSet set);

}  // namespace vat
