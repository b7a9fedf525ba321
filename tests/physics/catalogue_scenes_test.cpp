#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/validation/validate.h"
#include "protocol/scene/level.h"
#include "protocol/scene/scene_json.h"
#include "tests/support/scenes.h"

// Each catalogue scene: at the coarse level, which takes a fifth of the time, until its motion has
// passed, and at the level of its file through its first impacts.

namespace vat::catalogue_scenes_test {
namespace {

using namespace test;

const std::string kFolder = VAT_SOURCE_DIR "/protocol/scenes/";

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSeconds = 1;  // a hundred times slower
constexpr int kSecondsToRest = 1;
#else
constexpr int kSeconds = 10;
constexpr int kSecondsToRest = 20;
#endif

// The column of 0.8 m exerts 7850 Pa on its floor. The gas equation of state gives rho / rho0 - 1 =
// p / (c^2 rho0) = 3.5 % with c = 15 m/s. The mean over the liquid is half of that, which leaves as
// much again for impacts.
constexpr Real kMaxCompression = 0.035;

constexpr int kSecondsOfImpacts = 2;

void run_without_the_guard(const Scene& scene, int seconds) {
  ASSERT_TRUE(scene.vat.has_value());
  Simulation simulation = make_simulation(scene);
  const Diagnostics start = simulation.diagnostics();
  Real mean_error = 0;
  const int ticks = static_cast<int>(std::lround(seconds / scene.numerics.tick));
  for (int tick = 0; tick < ticks; ++tick) {
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    ASSERT_TRUE(report.events.empty())
        << to_string(report.events[0].cause) << " at " << report.events[0].time << " s";
    const Diagnostics now = simulation.diagnostics();
    ASSERT_EQ(now.particles_outside, 0U) << "at " << simulation.time() << " s";
    mean_error = std::max(mean_error, now.mean_density_error);
  }
  EXPECT_DOUBLE_EQ(simulation.time(), seconds);
  EXPECT_LT(mean_error, kMaxCompression);
  // Scenes that come to rest are at rest.
  if (scene.sleeping && seconds >= 20) {
    EXPECT_EQ(simulation.sleeping_body_count(), simulation.bodies().size());
  }
  // A vat at rest only dissipates energy if no body is driven and no liquid flows in.
  const bool is_driven = std::ranges::any_of(
      scene.bodies, [](const BodyDescription& body) { return body.motion.has_value(); });
  if (!scene.vat->motion && !is_driven && scene.emitters.empty()) {
    const Diagnostics end = simulation.diagnostics();
    EXPECT_LT(end.kinetic_energy + end.gravitational_energy,
              start.kinetic_energy + start.gravitational_energy);
  }
}

class CatalogueScene : public testing::TestWithParam<std::string> {};

TEST_P(CatalogueScene, RunsWithoutTheGuardAndStaysInItsVat) {
  const Result<Scene> scene = read_scene_file(kFolder + GetParam() + ".json");
  ASSERT_TRUE(scene.ok()) << scene.errors()[0].message;
  // A coarse scene can come to rest later: brick-wall moves for more than a minute.
  const bool sleeps = scene.value().sleeping.has_value();
  const int seconds = sleeps ? kSecondsToRest : kSeconds;
  const Result<Scene> coarse = at_level(scene.value(), Level::coarse);
  const bool can_be_coarse = !sleeps && coarse.ok() && find_errors(coarse.value()).empty();
  if (can_be_coarse) run_without_the_guard(coarse.value(), seconds);
  run_without_the_guard(scene.value(),
                        can_be_coarse ? std::min(kSecondsOfImpacts, seconds) : seconds);
}

std::vector<std::string> catalogue() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
    if (file.path().extension() == ".json") names.push_back(file.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

/// Returns the name of a test, which must not contain hyphens.
std::string test_name(const testing::TestParamInfo<std::string>& parameter) {
  std::string name = parameter.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, CatalogueScene, testing::ValuesIn(catalogue()), test_name);

}  // namespace
}  // namespace vat::catalogue_scenes_test
