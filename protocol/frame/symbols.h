#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>

#include "protocol/frame/rans.h"
#include "protocol/frame/residual_tables.h"

/// Symbols of FRAMES.md, "Symbols". SymbolWriter and SymbolReader have functions of the same names,
/// so that one template function can encode and decode.
namespace vat {

/// Class of a residual, and centre of the residual's distribution.
struct Expectation {
  std::uint32_t residual_class = 0;
  std::int32_t fraction = 0;  ///< prediction minus its integer part, -4 to 3 eighths
};

constexpr bool is_far(const Expectation& expected) {
  return expected.fraction >= 2 || expected.fraction <= -2;
}

/// Encoder of symbols. Each function writes its argument and returns it.
class SymbolWriter {
 public:
  static constexpr bool kReads = false;

  void clear() { coder_.clear(); }
  void finish(std::vector<std::uint8_t>& bytes) { coder_.finish(bytes); }

  /// Writes the lowest `count` bits of `value`. `count` is at most 12.
  std::uint32_t bits(std::uint32_t value, std::uint32_t count, std::uint32_t lane = 0) {
    if (count > 0) coder_.put(lane, value << (rans::kScaleBits - count), rans::kScale >> count);
    return value;
  }
  /// Writes a flag that is true with probability `chances` / 4096.
  bool flag(bool value, std::uint32_t chances) {
    coder_.put(0, value ? 0 : chances, value ? chances : rans::kScale - chances);
    return value;
  }
  std::uint32_t whole(std::uint32_t value, std::uint32_t lane = 0) {
    const auto length = static_cast<std::uint32_t>(std::bit_width(value));
    bits(length, 6, lane);
    for (std::uint32_t done = 0; done + 1 < length;) {
      const std::uint32_t count = std::min(length - 1 - done, 12U);
      bits(value >> done & ((1U << count) - 1), count, lane);
      done += count;
    }
    return value;
  }
  std::int32_t residual(std::int32_t value, const Expectation& expected, std::uint32_t lane) {
    const auto [table, low_bits] = residuals::class_of(expected.residual_class);
    const std::uint32_t index = residuals::Tables::index(table, is_far(expected));
    const std::int32_t radius = residuals::kAllTables.radius[index];
    const std::int32_t turned = expected.fraction < 0 ? -value : value;
    const std::int32_t high = turned >> low_bits;
    if (std::abs(high) <= radius) {
      put(index, static_cast<std::uint32_t>(high + radius), lane);
    } else {
      put(index, static_cast<std::uint32_t>(2 * radius + 1), lane);
      bits(high < 0 ? 1 : 0, 1, lane);
      whole(static_cast<std::uint32_t>(std::abs(high) - radius - 1), lane);
    }
    bits(static_cast<std::uint32_t>(turned) & ((1U << low_bits) - 1), low_bits, lane);
    return value;
  }

  bool is_sound() const { return true; }
  void refuse() {}
  bool may_hold(std::uint32_t) const { return true; }

 private:
  void put(std::uint32_t index, std::uint32_t symbol, std::uint32_t lane) {
    const std::uint32_t range = residuals::kAllTables.range[index][symbol];
    coder_.put(lane, range & 0xffff, range >> 16);
  }

  rans::Encoder coder_;
};

/// Decoder of symbols. The functions ignore the value arguments. After invalid input, is_sound() is
/// false permanently, and all further results are unspecified but in range.
class SymbolReader {
 public:
  static constexpr bool kReads = true;

  explicit SymbolReader(std::span<const std::uint8_t> bytes)
      : coder_(bytes), most_(8 * bytes.size()) {
    if (!coder_.states_are_valid()) refuse();
  }

  std::uint32_t bits(std::uint32_t, std::uint32_t count, std::uint32_t lane = 0) {
    if (count == 0) return 0;
    const std::uint32_t value = coder_.slot(lane) >> (rans::kScaleBits - count);
    coder_.take(lane, value << (rans::kScaleBits - count), rans::kScale >> count);
    return value;
  }
  bool flag(bool, std::uint32_t chances) {
    const bool value = coder_.slot(0) < chances;
    coder_.take(0, value ? 0 : chances, value ? chances : rans::kScale - chances);
    return value;
  }
  std::uint32_t whole(std::uint32_t, std::uint32_t lane = 0) {
    const std::uint32_t length = bits(0, 6, lane);
    if (length == 0) return 0;
    if (length > 32) {
      refuse();
      return 0;
    }
    std::uint32_t value = 0;
    for (std::uint32_t done = 0; done + 1 < length;) {
      const std::uint32_t count = std::min(length - 1 - done, 12U);
      value |= bits(0, count, lane) << done;
      done += count;
    }
    return value | 1U << (length - 1);
  }
  std::int32_t residual(std::int32_t, const Expectation& expected, std::uint32_t lane) {
    const auto [table, low_bits] = residuals::class_of(expected.residual_class);
    const std::uint32_t index = residuals::Tables::index(table, is_far(expected));
    const std::uint32_t symbol = residuals::kAllTables.symbol[index][coder_.slot(lane)];
    const std::uint32_t range = residuals::kAllTables.range[index][symbol];
    coder_.take(lane, range & 0xffff, range >> 16);
    const std::int32_t radius = residuals::kAllTables.radius[index];
    std::int32_t value = static_cast<std::int32_t>(symbol) - radius;
    if (value > radius) [[unlikely]] {
      value = escaped(radius, low_bits, lane);
    }
    if (low_bits > 0) {
      value = value * (1 << low_bits) + static_cast<std::int32_t>(bits(0, low_bits, lane));
    }
    return expected.fraction < 0 ? -value : value;
  }

  bool is_sound() const { return !was_refused_ && !coder_.ended_early(); }
  /// Marks the input as invalid. Has no effect if the decoder has passed the end of the data.
  void refuse() { was_refused_ = was_refused_ || !coder_.ended_early(); }
  bool was_refused() const { return was_refused_; }
  /// Returns whether the input can contain `count` items of at least one bit.
  bool may_hold(std::uint32_t count) const { return count <= most_; }
  const rans::Decoder& coder() const { return coder_; }

 private:
  std::int32_t escaped(std::int32_t radius, std::uint32_t low_bits, std::uint32_t lane) {
    const bool is_negative = bits(0, 1, lane) == 1;
    const std::uint32_t beyond = whole(0, lane);
    if (beyond >= 1U << (kMaxBits - low_bits)) {
      refuse();
      return 0;
    }
    const std::int32_t high = radius + 1 + static_cast<std::int32_t>(beyond);
    return is_negative ? -high : high;
  }

  static constexpr std::uint32_t kMaxBits = 30;  // greatest number of bits of a residual

  rans::Decoder coder_;
  bool was_refused_ = false;
  std::size_t most_;
};

}  // namespace vat
