#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/frame/rans.h"

/// How residuals are distributed: FRAMES.md, "Residuals". What predictions leave is logistic in
/// all scenes, whatever its scale, so that fixed tables of a few scales serve all frames.
namespace vat::residuals {

inline constexpr std::uint32_t kTables = 24;   // scales, a fourth of an octave apart
inline constexpr std::uint32_t kClasses = 68;  // and those that send low bits as they are
inline constexpr std::uint32_t kPlaces = 2;    // of the distribution's middle
inline constexpr int kMaxRadius = 18;
/// From this class on no residual has a probability above a half.
inline constexpr std::uint32_t kMinKeyClass = 14;

/// Of residuals from -radius to radius, and an escape behind them, which is symbol 2 radius + 1: by
/// table and by place, where the middle is one eighth above the prediction, or three.
struct Tables {
  static constexpr std::uint32_t kCount = kTables * kPlaces;
  static constexpr std::uint32_t kMaxSymbols = 2 * kMaxRadius + 2;

  std::array<std::int32_t, kCount> radius{};
  std::array<std::array<std::uint32_t, kMaxSymbols>, kCount> range{};   ///< start, 2^16 frequency
  std::array<std::array<std::uint8_t, rans::kScale>, kCount> symbol{};  ///< by slot

  static constexpr std::uint32_t index(std::uint32_t table, bool is_far) {
    return kPlaces * table + (is_far ? 1 : 0);
  }
};
extern const Tables kAllTables;

/// A class of residuals: a table for what is left of one without its low bits.
struct Class {
  std::uint32_t table = 0;
  std::uint32_t low_bits = 0;
};
constexpr Class class_of(std::uint32_t index) {
  if (index < kTables) return {index, 0};
  const std::uint32_t above = index - kTables;
  return {kTables - 4 + above % 4, 1 + above / 4};
}

}  // namespace vat::residuals
