#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

/// Drops with surface tension.
namespace vat::test {

inline constexpr Real kRadius = 0.05;   // [m]
inline constexpr Real kSigma = 0.5;     // [N/m]
inline constexpr Real kDensity = 1000;  // [kg/m^3]

/// Of surface waves as long as the drop [m/s].
inline Real capillary_speed() {
  return std::sqrt(kSigma / (kDensity * kRadius));
}

/// Expects a run without guard events.
inline void advance_for(Simulation& simulation, Real time) {
  const AdvanceReport report =
      simulation.advance(static_cast<std::uint32_t>(std::lround(time / simulation.step_size())));
  EXPECT_TRUE(report.events.empty());
}

}  // namespace vat::test
