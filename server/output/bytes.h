#pragma once

#include <array>
#include <bit>
#include <string>
#include <type_traits>

namespace vat {

// The formats .npy and .ply require little-endian numbers, which are copied from memory.
static_assert(std::endian::native == std::endian::little);

/// Appends the bytes of a number in memory order.
template <class Number>
void append_bytes(std::string& bytes, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  const auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
  bytes.append(raw.data(), raw.size());
}

}  // namespace vat
