#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/kernels/lattice_sum.h"
#include "core/kernels/mueller_kernels.h"
#include "core/kernels/smoothing_kernel.h"
#include "tests/core/kernels/quadrature.h"

namespace vat::test::kernel_test {
namespace {

struct Kernel {
  const char* name;
  std::function<Real(Real)> value;
  std::function<Real(Real)> slope;  ///< dW/dr; empty if unused
};

std::vector<Kernel> kernels(Real h, int dimensions) {
  const auto smoothing = [&](const char* name, KernelId id) {
    const SmoothingKernel kernel(id, h, dimensions);
    return Kernel{name, [=](Real r) { return kernel.value(r); },
                  [=](Real r) { return kernel.slope_over_r(r) * r; }};
  };
  const Poly6 poly6(h, dimensions);
  const Spiky spiky(h, dimensions);
  const ViscosityKernel viscosity(h, dimensions);
  return {{"poly6", [=](Real r) { return poly6.value(r * r); }, {}},
          {"spiky", [=](Real r) { return spiky.value(r); }, [=](Real r) { return spiky.slope(r); }},
          {"viscosity", [=](Real r) { return viscosity.value(r); }, {}},
          smoothing("wendland", KernelId::wendland_c2),
          smoothing("spline", KernelId::cubic_spline)};
}

/// Calls f(kernel, support, dimensions) for every kernel.
template <class F>
void for_each_kernel(F&& f) {
  for (const int dimensions : {2, 3}) {
    for (const Real h : {0.04, 1.0, 3.5}) {
      for (const Kernel& kernel : kernels(h, dimensions)) {
        SCOPED_TRACE(testing::Message() << kernel.name << ' ' << dimensions << ' ' << h);
        f(kernel, h, dimensions);
      }
    }
  }
}

TEST(Kernel, IntegratesToOne) {
  for_each_kernel([](const Kernel& kernel, Real h, int dimensions) {
    const Real integral = integrate(0, h, [&](Real r) {
      return 2 * std::numbers::pi * r * (dimensions == 3 ? 2 * r : 1) * kernel.value(r);
    });
    EXPECT_NEAR(integral, 1, 1e-10);
  });
}

TEST(Kernel, FallsToZeroAtItsSupportWithItsSlope) {
  for_each_kernel([](const Kernel& kernel, Real h, int dimensions) {
    const Real scale = std::pow(h, -dimensions);
    EXPECT_NEAR(kernel.value(h), 0, 1e-12 * scale);
    if (kernel.slope) {
      EXPECT_NEAR(kernel.slope(h), 0, 1e-12 * scale / h);
    }
    for (int n = 1; n < 100; ++n) {
      const Real r = h * n / 100;
      EXPECT_GT(kernel.value(r), kernel.value(r + 0.005 * h));
      if (!kernel.slope) continue;
      // The error of the central difference of a polynomial is step^2 W'''/6.
      const Real step = 1e-5 * h;
      const Real difference = (kernel.value(r + step) - kernel.value(r - step)) / (2 * step);
      EXPECT_NEAR(kernel.slope(r), difference, 2e-8 * scale / h) << r / h;
      EXPECT_LT(kernel.slope(r), 0);
    }
  });
}

TEST(Kernel, LaplacianIsThatOfTheViscosityKernelAndNeverNegative) {
  for (const int dimensions : {2, 3}) {
    for (const Real h : {0.04, 1.0, 3.5}) {
      const ViscosityKernel kernel(h, dimensions);
      const Real step = 1e-3 * h;
      for (int n = 10; n < 100; ++n) {
        const Real r = h * n / 100;
        // (r^k W')' / r^k by differences of differences. Their error is step^2 times derivatives of
        // W. The derivatives of the logarithm or of 1/r are the largest.
        const auto flux = [&](Real s) {
          return std::pow(s, dimensions - 1) *
                 (kernel.value(s + step / 2) - kernel.value(s - step / 2)) / step;
        };
        const Real difference =
            (flux(r + step / 2) - flux(r - step / 2)) / (step * std::pow(r, dimensions - 1));
        const Real derivatives = kernel.laplacian_scale() * h / std::pow(r / h, dimensions + 2);
        EXPECT_NEAR(kernel.laplacian(r), difference, step * step / (h * h) * derivatives);
        EXPECT_GT(kernel.laplacian(r), 0);
      }
      EXPECT_NEAR(kernel.laplacian(h), 0, 1e-12 / std::pow(h, dimensions + 2));
    }
  }
}

// LIQ-1 of the validation, by an independent computation to six digits. A liquid starts as a
// lattice.
TEST(Kernel, SumsOverALattice) {
  struct Row {
    Real ratio;
    std::array<Real, 4> sums;  ///< poly6, spiky, Wendland, spline
  };
  constexpr std::array<Row, 5> kRows = {{{1.8, {0.982843, 1.347022, 1.065562, 1.000184}},
                                         {2.0, {1.009775, 1.235890, 1.033843, 0.999972}},
                                         {2.5, {0.995431, 1.096233, 1.013365, 0.998517}},
                                         {3.0, {1.002189, 1.047449, 1.003141, 1.001795}},
                                         {4.0, {0.999998, 1.014817, 1.000549, 1.000079}}}};
  for (const auto& [ratio, sums] : kRows) {
    const std::vector<Kernel> all = kernels(ratio, 3);
    const auto sum = [&, h = ratio](std::size_t k) {
      return sum_over_lattice(h, 1, 3, [&](Real, Real r) { return all[k].value(r); });
    };
    EXPECT_NEAR(sum(0), sums[0], 1e-6) << ratio;
    EXPECT_NEAR(sum(1), sums[1], 1e-6) << ratio;
    for (const std::size_t k : {0U, 1U}) {
      const SmoothingKernel kernel(static_cast<KernelId>(k), ratio, 3);
      EXPECT_NEAR(lattice_sum(kernel, ratio, 1, 3), sums[2 + k], 1e-6) << k << ' ' << ratio;
    }
  }
}

// By integration by parts, the sum of slopes equals the integral of the kernel, except for the
// lattice's error.
TEST(Kernel, LatticeSlopesTendToOne) {
  for (const KernelId id : {KernelId::wendland_c2, KernelId::cubic_spline}) {
    for (const int dimensions : {2, 3}) {
      const auto error = [&](Real ratio) {
        const SmoothingKernel kernel(id, 1, dimensions);
        return std::abs(lattice_slope(kernel, 1, 1 / ratio, dimensions) - 1);
      };
      EXPECT_GT(error(2), 0.01) << dimensions;
      EXPECT_LT(error(8), 1e-3) << dimensions;
    }
  }
}

}  // namespace
}  // namespace vat::test::kernel_test
