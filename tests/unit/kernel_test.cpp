#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/kernels/poly6.h"
#include "core/kernels/spiky.h"
#include "core/kernels/viscosity_kernel.h"

namespace vat::kernel_test {
namespace {

constexpr Real kSupports[] = {0.04, 1.0, 3.5};

/// Integral of a radial kernel over its ball: 4 pi r^2 W(r) by composite Gauss-Legendre of three
/// points, exact for the polynomials of degree 5 on each piece.
Real integrate(Real h, const std::function<Real(Real)>& w) {
  constexpr int kPieces = 2000;
  const Real offset = std::sqrt(3.0 / 5);
  const Real half = h / kPieces / 2;
  Real sum = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const Real middle = (2 * piece + 1) * half;
    const auto at = [&](Real r) { return 4 * std::numbers::pi * r * r * w(r); };
    sum += half / 9 *
           (5 * at(middle - offset * half) + 8 * at(middle) + 5 * at(middle + offset * half));
  }
  return sum;
}

/// Sum of V W over a simple cubic lattice of spacing 1, at one of its sites.
Real sum_over_lattice(Real h, const std::function<Real(Real)>& w) {
  const int reach = static_cast<int>(h) + 1;
  Real sum = 0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const Real r = std::sqrt(Real(x * x + y * y + z * z));
        if (r < h) sum += w(r);
      }
    }
  }
  return sum;
}

TEST(Kernel, IntegratesToOne) {
  for (const Real h : kSupports) {
    const Poly6 poly6(h);
    const Spiky spiky(h);
    const ViscosityKernel viscosity(h);
    EXPECT_NEAR(integrate(h, [&](Real r) { return poly6.value(r * r); }), 1, 1e-10);
    EXPECT_NEAR(integrate(h, [&](Real r) { return spiky.value(r); }), 1, 1e-10);
    EXPECT_NEAR(integrate(h, [&](Real r) { return viscosity.value(r); }), 1, 1e-10);
  }
}

// Sums computed on their own, to six digits: a lattice is how a liquid starts.
TEST(Kernel, SumsOverALattice) {
  struct Case {
    Real h, poly6, spiky;
  };
  for (const Case& c :
       {Case{1.8, 0.982843, 1.347022}, Case{2.0, 1.009775, 1.235890}, Case{2.5, 0.995431, 1.096233},
        Case{3.0, 1.002189, 1.047449}, Case{4.0, 0.999998, 1.014817}}) {
    const Poly6 poly6(c.h);
    const Spiky spiky(c.h);
    EXPECT_NEAR(sum_over_lattice(c.h, [&](Real r) { return poly6.value(r * r); }), c.poly6, 1e-6);
    EXPECT_NEAR(sum_over_lattice(c.h, [&](Real r) { return spiky.value(r); }), c.spiky, 1e-6);
  }
}

TEST(Kernel, VanishesAtItsSupport) {
  for (const Real h : kSupports) {
    EXPECT_NEAR(Poly6(h).value(h * h), 0, 1e-12 / (h * h * h));
    EXPECT_NEAR(Spiky(h).value(h), 0, 1e-12 / (h * h * h));
    EXPECT_NEAR(ViscosityKernel(h).value(h), 0, 1e-12 / (h * h * h));
    EXPECT_NEAR(Spiky(h).slope(h), 0, 1e-12 / (h * h * h * h));
    EXPECT_NEAR(ViscosityKernel(h).laplacian(h), 0, 1e-12 / std::pow(h, 5));
  }
}

TEST(Kernel, FallsFromTheCentreToTheSupport) {
  for (const Real h : kSupports) {
    const Poly6 poly6(h);
    const Spiky spiky(h);
    for (int n = 1; n < 1000; ++n) {
      const Real r = h * n / 1000;
      const Real before = h * (n - 1) / 1000;
      EXPECT_GT(poly6.value(before * before), poly6.value(r * r));
      EXPECT_GT(spiky.value(before), spiky.value(r));
      EXPECT_GT(poly6.value(r * r), 0);
      EXPECT_GT(spiky.value(r), 0);
    }
  }
}

TEST(Kernel, SlopeIsTheDerivative) {
  for (const Real h : kSupports) {
    const Spiky spiky(h);
    const Real step = 1e-5 * h;
    for (int n = 1; n < 100; ++n) {
      const Real r = h * n / 100;
      // The central difference of a cubic errs by step^2 W'''/6, W''' = -90/(pi h^6).
      const Real difference = (spiky.value(r + step) - spiky.value(r - step)) / (2 * step);
      const Real scale = spiky.value(0) / h;
      EXPECT_NEAR(spiky.slope(r), difference, 1e-9 * scale) << "r/h = " << r / h;
      EXPECT_LT(spiky.slope(r), 0);
    }
  }
}

TEST(Kernel, SlopeAtTheCentreStillPushes) {
  EXPECT_NEAR(Spiky(2).slope(0), -45 / (std::numbers::pi * 16), 1e-14);
}

TEST(Kernel, LaplacianIsThatOfTheKernelAndNeverNegative) {
  for (const Real h : kSupports) {
    const ViscosityKernel kernel(h);
    const Real step = 1e-3 * h;
    for (int n = 10; n < 100; ++n) {
      const Real r = h * n / 100;
      // (r W)'' / r, the Laplacian of a radial function; r W is a quartic, so the error of the
      // difference is step^2/12 times its constant fourth derivative, 90/(pi h^6), over r.
      const auto rw = [&](Real s) { return s * kernel.value(s); };
      const Real difference = (rw(r + step) - 2 * rw(r) + rw(r - step)) / (step * step * r);
      const Real bound = step * step / 12 * 90 / (std::numbers::pi * std::pow(h, 6)) / r;
      const Real round_off = 1e-15 * rw(step) / (step * step * r);
      EXPECT_NEAR(kernel.laplacian(r), difference, 1.01 * bound + 10 * round_off);
      EXPECT_GT(kernel.laplacian(r), 0);
    }
  }
}

}  // namespace
}  // namespace vat::kernel_test
