#include <gtest/gtest.h>

#include <set>

#include "tests/support/shaken_vat.h"

namespace vat::test::snapshot_test {
namespace {

constexpr std::uint32_t kSteps = 25;

/// A simulation with a grab and a timed force, so that the snapshot contains user actions.
Simulation make_busy(IntegratorId integrator = IntegratorId::velocity_verlet) {
  Simulation simulation = make_simulation(make_shaken_vat(integrator));
  const std::vector<BodyView> bodies = simulation.bodies();
  EXPECT_TRUE(simulation.grab_start(7, bodies[1].id, 5, {0.1, 0.1, 0.4}).ok());
  EXPECT_TRUE(simulation.apply_force(bodies[2].id, {5, 0, -3}, 0.04).ok());
  return simulation;
}

std::uint64_t hash_after(Simulation& simulation, std::uint32_t steps) {
  EXPECT_TRUE(simulation.advance(steps).events.empty());
  return simulation.state_hash();
}

BodyDescription make_newcomer() {
  return make_block("newcomer", BodyKind::liquid, "b", 3, {0.05, 0, 0.6}, Vec3::Zero());
}

TEST(Snapshot, TakingOneChangesNothing) {
  Simulation watched = make_busy();
  Simulation alone = make_busy();
  for (std::uint32_t n = 0; n < kSteps; ++n) {
    watched.snapshot();
    watched.advance(1);
  }
  EXPECT_EQ(watched.state_hash(), hash_after(alone, kSteps));
}

TEST(Snapshot, GivesAnIndependentSimulation) {
  Simulation original = make_busy();
  hash_after(original, kSteps);
  const Snapshot snapshot = original.snapshot();
  const std::uint64_t later = hash_after(original, kSteps);
  Simulation copy = Simulation::from(snapshot);
  EXPECT_EQ(copy.state_hash(), snapshot.state_hash());
  EXPECT_EQ(copy.instruction_set(), original.instruction_set());
  EXPECT_EQ(hash_after(copy, kSteps), later);
  EXPECT_EQ(original.state_hash(), later) << "the copy does not change the original";
}

TEST(Snapshot, BringsBackARemovedBody) {
  Simulation simulation = make_busy();
  hash_after(simulation, kSteps);
  const Snapshot snapshot = simulation.snapshot();
  const std::uint64_t later = hash_after(simulation, kSteps);
  simulation.restore(snapshot);
  const BodyId jelly = simulation.find_body("jelly").value();
  ASSERT_TRUE(simulation.remove_body(jelly).ok());
  EXPECT_NE(hash_after(simulation, kSteps), later);
  simulation.restore(snapshot);
  EXPECT_EQ(simulation.find_body("jelly"), jelly);
  EXPECT_EQ(hash_after(simulation, kSteps), later);
}

// Users may still use the id of the first added body.
TEST(Snapshot, RestoredGivesNoIdTwice) {
  Simulation simulation = make_busy();
  const Snapshot snapshot = simulation.snapshot();
  std::set<BodyId> ids;
  for (const BodyView& body : simulation.bodies()) ids.insert(body.id);
  for (int n = 0; n < 3; ++n) {
    const BodyId id = simulation.add_body(make_newcomer()).value();
    EXPECT_TRUE(ids.insert(id).second) << "id " << id;
    simulation.restore(snapshot);
    EXPECT_FALSE(simulation.find_body(id).has_value());
  }
}

}  // namespace
}  // namespace vat::test::snapshot_test
