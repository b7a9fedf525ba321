#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/support/check.h"

namespace vat {

/// Unsigned integer type with the size of T, for the bits of T.
template <class T>
using BitsOf = std::conditional_t<
    sizeof(T) == 1, std::uint8_t,
    std::conditional_t<sizeof(T) == 2, std::uint16_t,
                       std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

/// Writes `value` in little-endian order at `offset`. The bytes must exist.
template <class T>
void store(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
  VAT_ASSERT(offset + sizeof(T) <= bytes.size());
  const std::uint64_t bits = std::bit_cast<BitsOf<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[offset + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
}

/// Appends numbers in little-endian order to a byte vector.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  template <class T>
  void put(T value) {
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + sizeof(T));
    store<T>(bytes_, offset, value);
  }

 private:
  std::vector<std::uint8_t>& bytes_;
};

/// Reads numbers in little-endian order. Reads past the end return zeros, and ended_early() remains
/// true. A caller can therefore read a group of fields and check once.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    if (left() < sizeof(T)) {
      bytes_ = {};
      ended_early_ = true;
      return T{};
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) bits |= std::uint64_t{bytes_[i]} << (8 * i);
    bytes_ = bytes_.subspan(sizeof(T));
    return std::bit_cast<T>(static_cast<BitsOf<T>>(bits));
  }
  std::size_t left() const { return bytes_.size(); }
  bool ended_early() const { return ended_early_; }

 private:
  std::span<const std::uint8_t> bytes_;
  bool ended_early_ = false;
};

}  // namespace vat
