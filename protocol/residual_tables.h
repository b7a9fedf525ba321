#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/rans.h"

/// How residuals are distributed: PROTOCOL.md, "Residuals". What predictions leave is logistic in
/// all scenes, whatever its scale, so that fixed tables of a few scales serve all frames.
namespace vat::residuals {

inline constexpr std::uint32_t kTables = 24;   // scales, a fourth of an octave apart
inline constexpr std::uint32_t kClasses = 68;  // and those that send low bits as they are
inline constexpr std::size_t kPlaces = 2;      // of the distribution's middle
inline constexpr int kMostRadius = 18;
/// From this class on no residual has a probability above a half.
inline constexpr std::uint32_t kLeastKeyClass = 14;

/// Of residuals from -radius to radius, and an escape behind them.
struct Table {
  int radius = 0;
  std::array<std::uint8_t, rans::kScale> symbol{};  ///< by slot
  std::array<std::uint16_t, 2 * kMostRadius + 3> start{};

  std::uint32_t escape() const { return static_cast<std::uint32_t>(2 * radius + 1); }
};

/// By table, and by place: the middle is one eighth above the prediction, or three.
const std::array<std::array<Table, kPlaces>, kTables>& tables();

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
