#pragma once

#include <cstdint>
#include <vector>

namespace vat::test {

/// The beginning of a zstd frame that says how many bytes it holds, and holds none.
inline std::vector<std::uint8_t> bytes_that_say(std::uint32_t size) {
  std::vector<std::uint8_t> frame{0x28, 0xb5, 0x2f, 0xfd, 0xa0};  // the size in four bytes
  for (int byte = 0; byte < 4; ++byte) frame.push_back(static_cast<std::uint8_t>(size >> 8 * byte));
  return frame;
}

}  // namespace vat::test
