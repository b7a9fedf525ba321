#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "core/types.h"

/// What is around the content of a saved simulation: eight bytes that say what it is, the version
/// of the format in four, the instruction set in one, the content's length and checksum in eight
/// each.
namespace vat {

inline constexpr std::string_view kSavedMagic = "vat.sim\n";
inline constexpr std::uint32_t kSavedVersion = 1;
inline constexpr std::size_t kSavedHeaderSize = 29;

struct SavedContent {
  InstructionSet instructions;
  std::span<const std::uint8_t> bytes;
};

/// Bytes of a content to be appended; finish_saved() then fills in what the header says of it.
std::vector<std::uint8_t> begin_saved(InstructionSet instructions);
void finish_saved(std::vector<std::uint8_t>& bytes);

/// Fails with the code not_saved, other_version, wrong_length, damaged or bad_value.
Result<SavedContent> open_saved(std::span<const std::uint8_t> bytes);

}  // namespace vat
