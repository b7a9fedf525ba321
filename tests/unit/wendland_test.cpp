#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/kernels/wendland_c2.h"

namespace vat {
namespace {

constexpr Real kSupport = 0.3;

/// Integral of 2 pi r W dr in two dimensions, of 4 pi r^2 W dr in three, by midpoints.
Real integral(const WendlandC2& kernel, int dimensions) {
  constexpr int kCount = 4000;
  const Real dr = kSupport / kCount;
  Real sum = 0;
  for (int k = 0; k < kCount; ++k) {
    const Real r = (k + 0.5) * dr;
    const Real shell = dimensions == 3 ? 4 * std::numbers::pi * r * r : 2 * std::numbers::pi * r;
    sum += shell * kernel.value(r) * dr;
  }
  return sum;
}

TEST(WendlandC2, HasUnitIntegralAndVanishesAtItsSupport) {
  for (const int dimensions : {2, 3}) {
    const WendlandC2 kernel(kSupport, dimensions);
    EXPECT_NEAR(integral(kernel, dimensions), 1, 1e-6) << dimensions;
    EXPECT_NEAR(kernel.value(kSupport), 0, 1e-12);
    EXPECT_NEAR(kernel.slope_over_r(kSupport), 0, 1e-9);
  }
}

TEST(WendlandC2, SlopeIsTheDerivative) {
  for (const int dimensions : {2, 3}) {
    const WendlandC2 kernel(kSupport, dimensions, 1.3);
    for (const Real r : {0.01, 0.1, 0.2, 0.29}) {
      constexpr Real kStep = 1e-6;
      const Real slope = (kernel.value(r + kStep) - kernel.value(r - kStep)) / (2 * kStep);
      EXPECT_NEAR(kernel.slope_over_r(r) * r, slope, 1e-6 * std::abs(slope) + 1e-6);
    }
  }
}

// LIQ-1: sums over a simple cubic lattice.
TEST(WendlandC2, LatticeSumsAreThoseOfTheDossier) {
  const auto sum = [](Real ratio) {
    return lattice_sum(WendlandC2(kSupport, 3), kSupport, kSupport / ratio, 3);
  };
  EXPECT_NEAR(sum(1.8), 1.065562, 1e-6);
  EXPECT_NEAR(sum(2.0), 1.033843, 1e-6);
  EXPECT_NEAR(sum(2.5), 1.013365, 1e-6);
  EXPECT_NEAR(sum(3.0), 1.003141, 1e-6);
  EXPECT_NEAR(sum(4.0), 1.000549, 1e-6);
}

// By parts the slope's sum is the kernel's integral, but for what a lattice misses of it.
TEST(WendlandC2, LatticeSlopesTendToOne) {
  for (const int dimensions : {2, 3}) {
    const auto error = [&](Real ratio) {
      const WendlandC2 kernel(kSupport, dimensions);
      return std::abs(lattice_slope(kernel, kSupport, kSupport / ratio, dimensions) - 1);
    };
    EXPECT_GT(error(2), 0.01) << dimensions;
    EXPECT_LT(error(8), 1e-3) << dimensions;
  }
}

}  // namespace
}  // namespace vat
