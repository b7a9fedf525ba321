#include "core/sampling/jitter.h"

#include <cstdint>

#include "core/support/check.h"

namespace vat {
namespace {

/// The output function of SplitMix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014), applied to a
/// counter.
std::uint64_t scramble(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

/// A uniform number in [-1, 1) with 53 random bits.
Real even(std::uint32_t seed, std::uint64_t draw) {
  const std::uint64_t bits = scramble(scramble(seed + std::uint64_t{1}) + draw + 1) >> 11U;
  return static_cast<Real>(bits) * 0x1p-52 - 1;
}

}  // namespace

void jitter(std::vector<Vec3>& points, Real greatest, std::uint32_t seed, int dimensions) {
  VAT_CHECK(greatest >= 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (dimensions == 2 && axis == 1) continue;
      points[i][axis] += greatest * even(seed, 3 * i + static_cast<std::uint64_t>(axis));
    }
  }
}

}  // namespace vat
