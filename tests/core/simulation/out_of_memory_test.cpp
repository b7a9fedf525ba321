#include <gtest/gtest.h>

#include <functional>
#include <new>

#include "tests/support/commands.h"
#include "tests/support/memory/allocation_counter.h"
#include "tests/support/shaken_vat.h"

// A command that runs out of memory at any allocation changes nothing.

namespace vat::test::out_of_memory_test {
namespace {

constexpr std::uint64_t kHand = 7;

/// A simulation after some steps, with an active grab and force.
Simulation make_busy(IntegratorId integrator) {
  Simulation simulation = make_simulation(make_shaken_vat(integrator));
  EXPECT_TRUE(simulation.advance(25).events.empty());
  const std::vector<BodyView> bodies = simulation.bodies();
  EXPECT_TRUE(simulation.grab_start(kHand, bodies[1].id, 5, {0.1, 0.1, 0.4}).ok());
  EXPECT_TRUE(simulation.apply_force(bodies[2].id, {5, 0, -3}, 3600).ok());
  return simulation;
}

/// Returns false if the command ran out of memory.
bool succeeds_within(std::size_t allocations, Simulation& simulation, const Command& command) {
  const AllocationLimit limit(allocations);
  try {
    EXPECT_TRUE(command(simulation).ok());
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

/// Lets the command fail at its first allocation, its second and so on, until it succeeds. Between
/// the attempts, compares the simulation with an undisturbed one.
void expect_all_or_nothing(Simulation& simulation, Simulation& undisturbed,
                           const Command& command) {
  constexpr std::size_t kTooMany = 100'000;
  std::size_t allowed = 0;
  std::uint64_t hash = simulation.state_hash();
  while (!succeeds_within(allowed, simulation, command)) {
    ASSERT_EQ(simulation.state_hash(), hash) << "after " << allowed << " allocations";
    simulation.advance(1);
    undisturbed.advance(1);
    hash = simulation.state_hash();
    ASSERT_EQ(hash, undisturbed.state_hash()) << "a step after " << allowed << " allocations";
    ASSERT_LT(++allowed, kTooMany);
  }
  EXPECT_GT(allowed, 0U) << "the command allocates nothing";
  EXPECT_TRUE(command(undisturbed).ok());
  EXPECT_EQ(simulation.state_hash(), undisturbed.state_hash());
  simulation.advance(50);
  undisturbed.advance(50);
  EXPECT_EQ(simulation.state_hash(), undisturbed.state_hash());
}

TEST(OutOfMemory, EveryCommandDoesAllOrNothing) {
  const auto newcomer = [](BodyKind kind) {
    return add_body(make_block("new", kind, "b", 2, {0.05, 0, 0.7}, Vec3::Zero()));
  };
  const std::map<std::string, Command> commands = {
      {"gravity", set_gravity({1, 2, -3})},
      {"interface", set_interface({{"a", "b"}, {900, 0.2}, 0.06})},
      {"add liquid", newcomer(BodyKind::liquid)},
      {"add deformable", newcomer(BodyKind::deformable)},
      {"add rigid", newcomer(BodyKind::rigid)},
      {"remove liquid", remove_body("pool")},
      {"remove deformable", remove_body("jelly")},
      {"remove rigid", remove_body("crate")},
      {"force", apply_force("pool", {1, 0, 0}, 3600)},
      {"grab", grab(kHand + 1, "crate", 0, {0, 0, 0.5})},
      // The new grab replaces the old one only if it succeeds.
      {"grab again", grab(kHand, "crate", 0, {0, 0, 0.5})}};
  for (const auto& [name, command] : commands) {
    SCOPED_TRACE(name);
    for (const IntegratorId integrator :
         {IntegratorId::velocity_verlet, IntegratorId::runge_kutta_4}) {
      Simulation simulation = make_busy(integrator);
      Simulation undisturbed = make_busy(integrator);
      expect_all_or_nothing(simulation, undisturbed, command);
    }
  }
}

TEST(OutOfMemory, RestoreDoesAllOrNothing) {
  // A snapshot can be restored only in its simulation, so each simulation has one with the same
  // content.
  std::vector<Simulation> simulations;
  std::vector<Snapshot> snapshots;
  for (int n = 0; n < 2; ++n) {
    Simulation simulation = make_busy(IntegratorId::velocity_verlet);
    snapshots.push_back(simulation.snapshot());
    ASSERT_TRUE(simulation.remove_body(simulation.find_body("jelly").value()).ok());
    simulations.push_back(std::move(simulation));
  }
  expect_all_or_nothing(simulations[0], simulations[1], [&](Simulation& s) {
    s.restore(snapshots[&s == &simulations[0] ? 0 : 1]);
    EXPECT_TRUE(s.find_body("jelly").has_value());
    return Status();
  });
}

/// The first call of advance() allocates all buffers. It fails at each allocation in turn, then
/// continues without a difference.
void expect_first_advance_to_survive(const Scene& scene, std::uint32_t steps) {
  Simulation undisturbed = make_simulation(scene);
  const std::uint64_t start = undisturbed.state_hash();
  undisturbed.advance(steps);
  const std::uint64_t later = undisturbed.state_hash();
  const Command first_call = [&](Simulation& simulation) {
    simulation.advance(steps);
    return Status();
  };
  for (std::size_t allowed = 0;; ++allowed) {
    Simulation simulation = make_simulation(scene);
    const bool succeeded = succeeds_within(allowed, simulation, first_call);
    if (!succeeded) {
      ASSERT_EQ(simulation.state_hash(), start) << "after " << allowed << " allocations";
      ASSERT_EQ(simulation.time(), 0);
      simulation.advance(steps);
    }
    ASSERT_EQ(simulation.state_hash(), later) << "after " << allowed << " allocations";
    if (!succeeded) continue;
    EXPECT_GT(allowed, 20U);
    return;
  }
}

TEST(OutOfMemory, AdvanceDoesAllOrNothing) {
  for (const IntegratorId integrator : kIntegrators) {
    SCOPED_TRACE(to_string(integrator));
    expect_first_advance_to_survive(make_shaken_vat(integrator), 10);
  }
}

// The guard's report allocates too.
TEST(OutOfMemory, AdvanceThatTheGuardWatchesDoesAllOrNothing) {
  Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
  scene.bodies[2].velocity = {0, 0, 40};
  EXPECT_GT(make_simulation(scene).advance(10).undone_steps, 5U);
  expect_first_advance_to_survive(scene, 10);
}

}  // namespace
}  // namespace vat::test::out_of_memory_test
