#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"

/// Content behind a header that tells what it is and whether it is whole: eight bytes that name the
/// sort, the version of its format in four, the content's length and checksum in eight each.
namespace vat {

inline constexpr std::size_t kSealSize = 28;
inline constexpr std::size_t kSealVersionAt = 8;

/// A sort of content.
struct Seal {
  std::string_view magic;  ///< eight bytes
  std::uint32_t version = 0;
  std::string_view name;  ///< for messages: "a saved simulation"
};

/// Bytes for the content to be appended to; close_seal() then fills in what the header says of it.
std::vector<std::uint8_t> begin_sealed(const Seal& seal);
void close_seal(std::vector<std::uint8_t>& bytes);

/// The content. Fails with the code other_format, other_version, wrong_length or damaged.
Result<std::span<const std::uint8_t>> open_sealed(const Seal& seal,
                                                  std::span<const std::uint8_t> bytes);

}  // namespace vat
