#pragma once

#include <cstdint>
#include <string_view>

namespace vat {

/// Returns the CRC-32 (IEEE 802.3) of `bytes` after bytes whose CRC-32 is `earlier`.
std::uint32_t crc32(std::string_view bytes, std::uint32_t earlier = 0);

}  // namespace vat
