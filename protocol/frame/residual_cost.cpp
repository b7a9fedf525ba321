#include <algorithm>
#include <cmath>
#include <vector>

#include "protocol/frame/block_coder.h"

namespace vat {
namespace {

constexpr std::int32_t kListed = 64;

float cost_in(std::uint32_t residual_class, std::int32_t residual) {
  const auto [table, low_bits] = residuals::class_of(residual_class);
  const std::uint32_t index = residuals::Tables::index(table, false);
  const std::int32_t radius = residuals::kAllTables.radius[index];
  const std::int32_t high = residual >> low_bits;
  const std::int32_t symbol = std::min(high, radius + 1) + radius;
  const std::uint32_t range = residuals::kAllTables.range[index][static_cast<std::size_t>(symbol)];
  const float bits = 12 - std::log2(static_cast<float>(range >> 16)) + static_cast<float>(low_bits);
  if (high <= radius) return bits;
  return bits + 7 + std::log2(static_cast<float>(high - radius));
}

}  // namespace

float residual_cost(std::uint32_t residual_class, std::int32_t residual) {
  static const auto kCosts = [] {
    std::vector<float> costs;
    for (std::uint32_t c = 0; c < residuals::kClasses; ++c) {
      for (std::int32_t r = 0; r < kListed; ++r) costs.push_back(cost_in(c, r));
    }
    return costs;
  }();
  const std::int32_t size = std::abs(residual);
  if (size >= kListed) return cost_in(residual_class, size);
  return kCosts[residual_class * kListed + static_cast<std::uint32_t>(size)];
}

}  // namespace vat
