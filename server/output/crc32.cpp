#include "server/output/crc32.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace vat {

namespace {

constexpr std::size_t kCrcSlices = 8;  // bytes of one step, with one table each
using CrcTables = std::array<std::array<std::uint32_t, 256>, kCrcSlices>;

CrcTables make_crc_tables() {
  constexpr std::uint32_t kPolynomial = 0xEDB88320;  // reversed
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < kCrcSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[slice - 1][byte];
      tables[slice][byte] = (crc >> 8) ^ tables[0][crc & 255];
    }
  }
  return tables;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t earlier) {
  static_assert(std::endian::native == std::endian::little);
  static const CrcTables kCrcTables = make_crc_tables();
  std::uint32_t crc = ~earlier;
  for (; bytes.size() >= kCrcSlices; bytes.remove_prefix(kCrcSlices)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof word);
    word ^= crc;
    crc = 0;
    for (std::size_t slice = 0; slice < kCrcSlices; ++slice) {
      crc ^= kCrcTables[kCrcSlices - 1 - slice][(word >> (8 * slice)) & 255];
    }
  }
  for (const char byte : bytes) {
    crc = (crc >> 8) ^ kCrcTables[0][(crc ^ static_cast<unsigned char>(byte)) & 255];
  }
  return ~crc;
}

}  // namespace vat
