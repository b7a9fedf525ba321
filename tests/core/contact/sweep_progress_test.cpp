#include "core/contact/projection/sweep_progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vat::sweep_progress_test {
namespace {

constexpr Real kTolerance = 1e-8;

void add_rounds(SweepProgress& progress, std::size_t count, Real factor, Real& change) {
  for (std::size_t n = 0; n < count; ++n) progress.add(change *= factor);
}

TEST(SweepProgress, PredictsTheRoundsOfAGeometricDecrease) {
  for (const Real factor : {0.1, 0.5, 0.9, 0.999}) {
    SweepProgress progress(kTolerance);
    Real change = 1e-3;
    add_rounds(progress, 4, factor, change);
    for (const std::size_t rounds : {4U, 8U, 16U}) {
      ASSERT_TRUE(progress.has_prediction()) << rounds;
      EXPECT_EQ(progress.rounds(), rounds);
      const Real exact = std::log(kTolerance / change) / std::log(factor);
      EXPECT_NEAR(progress.rounds_left(), exact, 1e-9 * std::abs(exact)) << factor;
      for (std::size_t n = 1; n < rounds; ++n) {
        add_rounds(progress, 1, factor, change);
        EXPECT_FALSE(progress.has_prediction()) << rounds << " and " << n;
      }
      add_rounds(progress, 1, factor, change);
    }
  }
}

TEST(SweepProgress, UsesTheSecondHalfOfTheRounds) {
  SweepProgress progress(kTolerance);
  Real change = 1;
  add_rounds(progress, 4, 0.1, change);
  add_rounds(progress, 4, 0.5, change);
  EXPECT_NEAR(progress.rounds_left(), std::log(kTolerance / change) / std::log(0.5), 1e-9);
}

TEST(SweepProgress, PredictsNoEndWithoutADecrease) {
  for (const Real factor : {1.0, 1.5}) {
    SweepProgress progress(kTolerance);
    Real change = 1e-3;
    add_rounds(progress, 4, factor, change);
    EXPECT_EQ(progress.rounds_left(), std::numeric_limits<Real>::infinity());
  }
}

TEST(SweepProgress, WaitsLongerAfterARestart) {
  SweepProgress progress(kTolerance);
  Real change = 1;
  add_rounds(progress, 4, 0.1, change);
  progress.restart();
  EXPECT_EQ(progress.rounds(), 0U);
  change = 1;
  add_rounds(progress, 4, 0.5, change);
  EXPECT_FALSE(progress.has_prediction());
  add_rounds(progress, 4, 0.5, change);
  ASSERT_TRUE(progress.has_prediction());
  EXPECT_NEAR(progress.rounds_left(), std::log(kTolerance / change) / std::log(0.5), 1e-9);
}

}  // namespace
}  // namespace vat::sweep_progress_test
