#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vat {

/// Returns the data as a zstd frame with a checksum.
std::vector<std::uint8_t> compress(std::span<const std::uint8_t> bytes);

/// Returns the data of a zstd frame. Throws StorageError (kind `corrupt`) if the frame is damaged
/// or has more than `max_bytes` of data.
std::vector<std::uint8_t> decompress(std::span<const std::uint8_t> frame, std::size_t max_bytes);

}  // namespace vat
