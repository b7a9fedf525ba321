#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vat {

/// Returns the bytes as base64 with padding (RFC 4648, section 4).
std::string to_base64(std::span<const std::uint8_t> bytes);
/// Returns the bytes of a base64 text with padding, or nothing if the text is invalid.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace vat
