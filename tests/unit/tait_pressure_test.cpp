#include <gtest/gtest.h>

#include <cmath>

#include "core/forces/weakly_compressible_pairs.h"

namespace vat::tait_pressure_test {
namespace {

TEST(TaitPressure, IsTaitsEquationUpToThreePercent) {
  for (const Real s : {0.5, 0.99, 1.0, 1.01, 1.03}) {
    EXPECT_NEAR(tait_pressure(s), (std::pow(s, 7) - 1) / 7, 1e-15) << s;
  }
}

TEST(TaitPressure, IsLinearInTheVolumeBeyond) {
  for (const Real s : {1.0300001, 1.2, 2.0}) {
    EXPECT_NEAR(tait_pressure(s), tait_pressure(1.03) + 0.9 * (1 / 1.03 - 1 / s), 1e-15) << s;
  }
}

TEST(TaitPressure, GoesOnAlongItsTangentFromTwiceTheDensity) {
  for (const Real s : {2.0, 3.0, 10.0}) {
    EXPECT_NEAR(tait_pressure(s), tait_pressure(2) + 0.225 * (s - 2), 1e-15 * s) << s;
  }
}

}  // namespace
}  // namespace vat::tait_pressure_test
