#include "core/kernels/smoothing_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/scene/scene.h"

namespace vat::smoothing_kernel_test {
namespace {

constexpr Real kSupport = 0.3;

class Smoothing : public testing::TestWithParam<KernelId> {};

/// Integral of 2 pi r W dr in two dimensions, of 4 pi r^2 W dr in three, by midpoints.
Real integral(const SmoothingKernel& kernel, int dimensions) {
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

TEST_P(Smoothing, HasUnitIntegralAndVanishesAtItsSupport) {
  for (const int dimensions : {2, 3}) {
    const SmoothingKernel kernel(GetParam(), kSupport, dimensions);
    EXPECT_NEAR(integral(kernel, dimensions), 1, 1e-6) << dimensions;
    EXPECT_NEAR(kernel.value(kSupport), 0, 1e-12);
    EXPECT_NEAR(kernel.slope_over_r(kSupport), 0, 1e-9);
  }
}

TEST_P(Smoothing, SlopeIsTheDerivative) {
  for (const int dimensions : {2, 3}) {
    const SmoothingKernel kernel(GetParam(), kSupport, dimensions, 1.3);
    for (const Real r : {0.01, 0.1, 0.149, 0.151, 0.2, 0.29}) {
      constexpr Real kStep = 1e-6;
      const Real slope = (kernel.value(r + kStep) - kernel.value(r - kStep)) / (2 * kStep);
      EXPECT_NEAR(kernel.slope_over_r(r) * r, slope, 1e-6 * std::abs(slope) + 1e-6) << r;
    }
  }
}

// By parts the slope's sum is the kernel's integral, but for what a lattice misses of it.
TEST_P(Smoothing, LatticeSlopesTendToOne) {
  for (const int dimensions : {2, 3}) {
    const auto error = [&](Real ratio) {
      const SmoothingKernel kernel(GetParam(), kSupport, dimensions);
      return std::abs(lattice_slope(kernel, kSupport, kSupport / ratio, dimensions) - 1);
    };
    EXPECT_GT(error(2), 0.01) << dimensions;
    EXPECT_LT(error(8), 1e-3) << dimensions;
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, Smoothing,
                         testing::Values(KernelId::wendland_c2, KernelId::cubic_spline),
                         [](const auto& kernel) { return std::string(to_string(kernel.param)); });

// LIQ-1: sums over a simple cubic lattice.
TEST(SmoothingKernel, LatticeSumsAreThoseOfTheDossier) {
  struct Row {
    Real ratio;
    std::array<Real, 2> sums;  ///< in the order of KernelId
  };
  constexpr std::array<Row, 5> kRows = {{{1.8, {1.065562, 1.000184}},
                                         {2.0, {1.033843, 0.999972}},
                                         {2.5, {1.013365, 0.998517}},
                                         {3.0, {1.003141, 1.001795}},
                                         {4.0, {1.000549, 1.000079}}}};
  for (const auto& [ratio, sums] : kRows) {
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const SmoothingKernel kernel(static_cast<KernelId>(k), kSupport, 3);
      EXPECT_NEAR(lattice_sum(kernel, kSupport, kSupport / ratio, 3), sums[k], 1e-6)
          << to_string(static_cast<KernelId>(k)) << ' ' << ratio;
    }
  }
}

}  // namespace
}  // namespace vat::smoothing_kernel_test
