#pragma once

#include <array>
#include <cstdint>

#include "protocol/frame/rans.h"

/// Distributions of residuals (FRAMES.md, "Residuals"). In all scenes, residuals have a logistic
/// distribution of varying scale. Fixed tables for some scales are therefore sufficient.
namespace vat::residuals {

inline constexpr std::uint32_t kTables = 24;   // scales, each 2^(1/4) times the previous scale
inline constexpr std::uint32_t kClasses = 68;  // tables, and classes with uncoded low bits
inline constexpr std::uint32_t kPlaces = 2;    // positions of the distribution's centre
inline constexpr int kMaxRadius = 18;
/// First class in which each residual has a probability of at most 1/2.
inline constexpr std::uint32_t kMinKeyClass = 14;

/// Tables of the residuals -radius to radius and an escape symbol with the index 2 radius + 1.
/// There is one table for each scale and each position of the centre. The centre is 1/8 or 3/8
/// above an integer.
struct Tables {
  static constexpr std::uint32_t kCount = kTables * kPlaces;
  static constexpr std::uint32_t kMaxSymbols = 2 * kMaxRadius + 2;

  std::array<std::int32_t, kCount> radius{};
  std::array<std::array<std::uint32_t, kMaxSymbols>, kCount> range{};  ///< start + 2^16 * frequency
  std::array<std::array<std::uint8_t, rans::kScale>, kCount> symbol{};  ///< indexed by slot

  static constexpr std::uint32_t index(std::uint32_t table, bool is_far) {
    return kPlaces * table + (is_far ? 1 : 0);
  }
};
extern const Tables kAllTables;

/// Parameters of a residual class: number of low bits without entropy coding, and table of the
/// other bits.
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
