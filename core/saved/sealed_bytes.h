#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"

/// Content with a header that identifies and verifies the content. The header contains a magic
/// number (8 bytes), the format version (4 bytes), and the length and the checksum of the content
/// (8 bytes each).
namespace vat {

inline constexpr std::size_t kSealSize = 28;
inline constexpr std::size_t kSealVersionAt = 8;

/// Identification of a type of content.
struct Seal {
  std::string_view magic;  ///< magic number of eight bytes
  std::uint32_t version = 0;
  std::string_view name;                   ///< for error messages: "a saved simulation"
  std::uint32_t oldest_version = version;  ///< oldest version that this program reads
};

/// begin_sealed() returns a header to which the caller appends the content. close_seal() then
/// completes the header.
std::vector<std::uint8_t> begin_sealed(const Seal& seal);
void close_seal(std::vector<std::uint8_t>& bytes);

/// Returns the content without its header. Fails with the code other_format, other_version,
/// wrong_length or damaged.
Result<std::span<const std::uint8_t>> open_sealed(const Seal& seal,
                                                  std::span<const std::uint8_t> bytes);
/// Returns the format version of bytes that open_sealed() accepts.
std::uint32_t sealed_version(std::span<const std::uint8_t> bytes);

}  // namespace vat
