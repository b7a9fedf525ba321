#include <gtest/gtest.h>

#include <cmath>

#include "core/forces/weakly_compressible_pairs.h"

namespace vat {
namespace {

TEST(TaitPressure, IsTaitsEquationUpToATenth) {
  for (const Real s : {0.5, 0.99, 1.0, 1.01, 1.1}) {
    EXPECT_NEAR(tait_pressure(s), (std::pow(s, 7) - 1) / 7, 1e-15) << s;
  }
}

// Sound is never faster than at 1.1, however far an impact presses a liquid together.
TEST(TaitPressure, GoesAlongItsTangentBeyond) {
  const Real slope = std::pow(1.1, 6);
  for (const Real s : {1.1000001, 1.2, 2.0, 10.0}) {
    EXPECT_NEAR(tait_pressure(s), tait_pressure(1.1) + slope * (s - 1.1), 1e-14 * s) << s;
  }
}

}  // namespace
}  // namespace vat
