#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "protocol/scene_json.h"
#include "tests/support/scenes.h"

// Each scene of the catalogue, two seconds of it: in full they run twenty.

namespace vat {
namespace {

using namespace test;

class CatalogueScene : public testing::TestWithParam<const char*> {};

TEST_P(CatalogueScene, RunsWithoutTheGuardAndStaysInItsVat) {
  const Result<Scene> scene =
      read_scene_file(std::string(VAT_SOURCE_DIR "/protocol/scenes/") + GetParam() + ".json");
  ASSERT_TRUE(scene.ok()) << scene.errors()[0].message;
  ASSERT_TRUE(scene.value().vat.has_value());
  Simulation simulation = make_simulation(scene.value());
  const Real energy_at_start =
      simulation.diagnostics().kinetic_energy + simulation.diagnostics().gravitational_energy;
  for (int tick = 0; tick < 100; ++tick) {
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    ASSERT_TRUE(report.events.empty())
        << to_string(report.events[0].cause) << " at " << report.events[0].time << " s";
    ASSERT_EQ(simulation.diagnostics().particles_outside, 0U) << "at " << simulation.time() << " s";
  }
  EXPECT_DOUBLE_EQ(simulation.time(), 2);
  const Diagnostics end = simulation.diagnostics();
  EXPECT_LT(end.max_density_error, 1);
  // A vat that stands still takes energy only.
  if (!scene.value().vat->motion) {
    EXPECT_LT(end.kinetic_energy + end.gravitational_energy, energy_at_start);
  }
}

/// Names of tests have no hyphens.
std::string test_name(const testing::TestParamInfo<const char*>& parameter) {
  std::string name = parameter.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, CatalogueScene,
                         testing::Values("buoyancy", "dam-break", "deformable-drop", "rigid-stack",
                                         "sliding-vat-liquid", "sliding-vat-solids"),
                         test_name);

}  // namespace
}  // namespace vat
