#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vat {

/// A zstd frame with a checksum.
std::vector<std::byte> compress(std::span<const std::byte> bytes);

/// Throws StorageError, of kind corrupt, for what is damaged or holds more than `max_bytes`.
std::vector<std::byte> decompress(std::span<const std::byte> frame, std::size_t max_bytes);

}  // namespace vat
