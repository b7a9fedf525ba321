#include "tests/stability/growth_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vat::stability::growth_sweep_test {
namespace {

struct GrowthCase {
  const char* family;
  int small;
  int large;
  double factor;  ///< maximum ratio of the iterations
};

// Without preconditioner and extrapolation, the iterations of a chain grow at least in proportion
// to its length, and those of a viscous liquid with the square root of its viscosity.
TEST(GrowthSweep, NeedsFewMoreIterationsForALargeProblem) {
  for (const auto& [name, small, large, factor] :
       {GrowthCase{"projected contacts", 5, 40, 2}, GrowthCase{"damping", 1000, 10'000, 3.2},
        GrowthCase{"implicit springs", 5, 200, 1.5},
        GrowthCase{"limited elongation", 20, 200, 2}}) {
    const auto family = std::ranges::find(growth_families(), std::string(name),
                                          [](const auto& one) { return std::string(one.name); });
    ASSERT_NE(family, growth_families().end()) << name;
    const GrowthPoint few = measure_growth(*family, small, 100);
    const GrowthPoint many = measure_growth(*family, large, 100);
    EXPECT_EQ(few.events + many.events, 0U) << name;
    EXPECT_GT(few.iterations, 0) << name;
    EXPECT_LT(many.iterations, factor * few.iterations) << name;
  }
}

}  // namespace
}  // namespace vat::stability::growth_sweep_test
