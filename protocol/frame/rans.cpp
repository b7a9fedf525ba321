#include "protocol/frame/rans.h"

#include <bit>

namespace vat::rans {
namespace {

/// Exact division by multiplication: x / f = x * factor >> shift for all x below 2^31.
struct Reciprocal {
  std::uint32_t factor = 0;
  std::uint32_t shift = 0;
};

std::array<Reciprocal, kScale + 1> make_reciprocals() {
  std::array<Reciprocal, kScale + 1> table{};
  for (std::uint32_t f = 1; f <= kScale; ++f) {
    const auto bits = static_cast<std::uint32_t>(std::bit_width(f - 1));
    const std::uint64_t power = std::uint64_t{1} << (31 + bits);
    table[f] = {static_cast<std::uint32_t>((power + f - 1) / f), 31 + bits};
  }
  return table;
}

}  // namespace

void Encoder::finish(std::vector<std::uint8_t>& bytes) {
  static const std::array<Reciprocal, kScale + 1> kReciprocals = make_reciprocals();
  std::array<std::uint32_t, kLanes> states;
  states.fill(kMinState);
  words_.resize(symbols_.size());  // each symbol writes at most one
  std::uint16_t* const begin = words_.data();
  std::uint16_t* out = begin;
  for (std::size_t i = symbols_.size(); i-- > 0;) {
    const std::uint32_t symbol = symbols_[i];
    const std::uint32_t start = symbol & (kScale - 1);
    const std::uint32_t frequency = symbol >> 12 & (2 * kScale - 1);
    std::uint32_t state = states[symbol >> 25];
    if (state >= frequency << 19) {
      *out++ = static_cast<std::uint16_t>(state);
      state >>= 16;
    }
    const auto [factor, shift] = kReciprocals[frequency];
    const auto quotient = static_cast<std::uint32_t>(std::uint64_t{state} * factor >> shift);
    states[symbol >> 25] = state + quotient * (kScale - frequency) + start;
  }
  const auto words = static_cast<std::size_t>(out - begin);
  bytes.reserve(bytes.size() + kStateBytes + 2 * words);
  for (const std::uint32_t state : states) {
    for (int byte = 0; byte < 4; ++byte) {
      bytes.push_back(static_cast<std::uint8_t>(state >> (8 * byte)));
    }
  }
  for (std::size_t i = words; i-- > 0;) {
    bytes.push_back(static_cast<std::uint8_t>(words_[i]));
    bytes.push_back(static_cast<std::uint8_t>(words_[i] >> 8));
  }
}

}  // namespace vat::rans
