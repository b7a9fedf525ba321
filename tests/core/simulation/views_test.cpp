// Views of bodies whose memory is kept.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/core/support/resting_scenes.h"
#include "tests/support/edited_scene.h"
#include "tests/support/mixed_scenes.h"

namespace vat::test::views_test {
namespace {

/// Copies of the values of a view.
struct Values {
  explicit Values(const BodyView& view)
      : positions(view.positions.begin(), view.positions.end()),
        velocities(view.velocities.begin(), view.velocities.end()),
        masses(view.masses.begin(), view.masses.end()),
        numbers(view.numbers.begin(), view.numbers.end()) {}
  bool operator==(const Values&) const = default;

  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::vector<Real> masses;
  std::vector<Index> numbers;
};

std::vector<Values> values_of(const std::vector<BodyView>& views) {
  return {views.begin(), views.end()};
}

/// Changes a simulation whose views are kept, and one without views.
void expect_kept(const Scene& scene, std::uint32_t steps) {
  Simulation simulation = make_simulation(scene);
  Simulation other = make_simulation(scene);
  simulation.advance(steps);
  other.advance(steps);
  const std::vector<BodyView> views = simulation.bodies();
  const std::vector<Values> values = values_of(views);
  const std::shared_ptr<const void> kept = simulation.keep_views();
  EXPECT_EQ(values_of(simulation.bodies()), values);
  for (Simulation* each : {&simulation, &other}) {
    each->advance(10);
    ASSERT_TRUE(each->remove_body(views.front().id).ok());
    each->advance(10);
  }
  EXPECT_EQ(values_of(views), values);
  EXPECT_NE(values_of(simulation.bodies()), values);
  EXPECT_EQ(simulation.state_hash(), other.state_hash());
}

TEST(Views, KeptViewsHaveTheirValuesAfterChanges) {
  expect_kept(sampled_scene(), 20);
}

TEST(Views, KeptViewsIncludeSleepers) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", 0.0), make_marble("marble", {5, 5, 6})};
  const std::uint32_t asleep = 200;
  Simulation simulation = make_advanced(scene, asleep);
  ASSERT_EQ(simulation.sleeping_body_count(), 1U);
  expect_kept(scene, asleep);
}

TEST(LiquidFields, OfAllBodiesAreThoseOfEachBody) {
  Simulation simulation =
      make_advanced(make_wet_mixture(IntegratorId::velocity_verlet, PressureSolver::tait), 5);
  const std::vector<BodyView> bodies = simulation.bodies();
  const std::vector<LiquidFields> fields = simulation.liquid_fields();
  ASSERT_EQ(fields.size(), bodies.size());
  std::size_t liquids = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Result<LiquidFields> own = simulation.liquid_fields(bodies[i].id);
    EXPECT_EQ(own.ok(), bodies[i].kind == BodyKind::liquid);
    liquids += own.ok() ? 1 : 0;
    EXPECT_EQ(fields[i].density, own.ok() ? own.value().density : std::vector<Real>());
    EXPECT_EQ(fields[i].pressure, own.ok() ? own.value().pressure : std::vector<Real>());
  }
  EXPECT_EQ(liquids, 2U);
}

}  // namespace
}  // namespace vat::test::views_test
