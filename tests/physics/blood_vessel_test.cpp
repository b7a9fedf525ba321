#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/scene/scene_json.h"
#include "tests/support/scenes.h"

// The catalogue scene in which liquid presses on soft tissue.

namespace vat::blood_vessel_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.025;
constexpr std::size_t kLayers = 3;  // layers of a wall

/// Returns the height of a wall's layer near x. Layer 0 is the lowest.
Real height_at(const BodyView& wall, std::size_t layer, Real x) {
  const std::size_t length = wall.positions.size() / kLayers;
  const auto row = wall.positions.subspan(layer * length, length);
  return std::ranges::min_element(row, {}, [&](const Vec3& p) { return std::abs(p.x() - x); })->z();
}

class BloodVessel : public testing::Test {
 protected:
  BloodVessel()
      : simulation_(make_simulation(
            read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/blood-vessel.json").value())) {}

  BodyView body(const char* name) const {
    return simulation_.find_body(simulation_.find_body(name).value()).value();
  }

  Simulation simulation_;
};

TEST_F(BloodVessel, HoldsItsBlood) {
  while (simulation_.time() < 10) {
    advance_to(simulation_, simulation_.time() + 0.1);
    const BodyView upper = body("upper wall");
    const BodyView lower = body("lower wall");
    for (const Vec3& place : body("blood").positions) {
      if (place.x() < 0.1 || place.x() > 2.2) continue;  // between pump and outlet
      // Particles beyond the middle layer would be leaking.
      ASSERT_LT(place.z(), height_at(upper, 1, place.x())) << simulation_.time() << " s";
      ASSERT_GT(place.z(), height_at(lower, 1, place.x())) << simulation_.time() << " s";
    }
  }
}

TEST_F(BloodVessel, SwellsWithEachBeatAndMostWhereTheTissueIsWeak) {
  const auto width_at = [&](Real x) {
    return height_at(body("upper wall"), 0, x) - height_at(body("lower wall"), kLayers - 1, x);
  };
  constexpr Real kPeriod = 1.4;
  constexpr Real kWeak = 1.45;
  constexpr Real kFirm = 0.6;
  advance_to(simulation_, 3 * kPeriod);
  for (int beat = 3; beat < 6; ++beat) {
    Real narrowest = std::numeric_limits<Real>::infinity();
    Real widest = 0;
    Real widest_weak = 0;
    while (simulation_.time() < (beat + 1) * kPeriod - 1e-9) {
      advance_to(simulation_, simulation_.time() + 0.02);
      narrowest = std::min(narrowest, width_at(kFirm));
      widest = std::max(widest, width_at(kFirm));
      widest_weak = std::max(widest_weak, width_at(kWeak));
    }
    EXPECT_GT(widest - narrowest, kSpacing) << "beat " << beat;
    EXPECT_GT(widest_weak, widest) << "beat " << beat;
  }
}

}  // namespace
}  // namespace vat::blood_vessel_test
