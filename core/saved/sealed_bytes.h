#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"

/// Content with a header that identifies and verifies it. The header has a magic (8 bytes), the
/// format version (4 bytes), and the length and the checksum of the content (8 bytes each).
namespace vat {

inline constexpr std::size_t kSealSize = 28;
inline constexpr std::size_t kSealVersionAt = 8;

/// A type of content.
struct Seal {
  std::string_view magic;  ///< eight bytes
  std::uint32_t version = 0;
  std::string_view name;  ///< for messages: "a saved simulation"
};

/// begin_sealed() returns bytes to which the content is appended; close_seal() then completes the
/// header.
std::vector<std::uint8_t> begin_sealed(const Seal& seal);
void close_seal(std::vector<std::uint8_t>& bytes);

/// Returns the content. Fails with the code other_format, other_version, wrong_length or damaged.
Result<std::span<const std::uint8_t>> open_sealed(const Seal& seal,
                                                  std::span<const std::uint8_t> bytes);

}  // namespace vat
