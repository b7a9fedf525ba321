#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/support/commands.h"
#include "tests/support/shaken_vat.h"

// The hash covers the complete start state of the next steps: equal hashes imply equal futures.

namespace vat::test::state_hash_test {
namespace {

constexpr std::uint32_t kSteps = 25;
constexpr std::uint64_t kHand = 7;

Simulation make_run(IntegratorId integrator) {
  Simulation simulation = make_simulation(make_shaken_vat(integrator));
  EXPECT_TRUE(simulation.advance(kSteps).events.empty());
  return simulation;
}

/// Commands with a later effect.
const std::map<std::string, Command> kChanges = {
    {"gravity", set_gravity({0, 0, -9.8})},
    {"grab of a deformable body", grab(kHand, "jelly", 5, {0, 0, 0.5})},
    {"grab of another particle", grab(kHand, "jelly", 6, {0, 0, 0.5})},
    {"grab of its middle, all of it in reach", grab(kHand, "jelly", 13, {0, 0, 0.5})},
    {"grab of a face, all of it in reach", grab(kHand, "jelly", 4, {0, 0, 0.5})},
    {"grab of a rigid body", grab(kHand, "crate", 5, {0, 0, 0.5})},
    {"grab with another target", grab(kHand, "crate", 5, {0, 0, 0.6})},
    {"grab that is moved", grab(kHand, "crate", 5, {0, 0, 0.5}) + move_grab(kHand, {0, 0.1, 0.5})},
    {"two grabs", grab(kHand, "crate", 5, {0, 0, 0.5}) + grab(kHand + 1, "jelly", 5, {0, 0, 0.5})},
    {"force", apply_force("crate", {1, 0, 0}, 0.01)},
    {"longer force of the same strength", apply_force("crate", {1, 0, 0}, 0.011)},
    {"stronger force", apply_force("crate", {2, 0, 0}, 0.01)},
    {"force on another body", apply_force("jelly", {1, 0, 0}, 0.01)}};

TEST(StateHash, DependsOnTheEffectOfEachCommand) {
  for (const IntegratorId integrator : kIntegrators) {
    std::map<std::uint64_t, std::string> seen;
    seen[make_run(integrator).state_hash()] = "nothing";
    for (const auto& [name, command] : kChanges) {
      Simulation simulation = make_run(integrator);
      ASSERT_TRUE(command(simulation).ok()) << name;
      const auto [other, is_new] = seen.emplace(simulation.state_hash(), name);
      EXPECT_TRUE(is_new) << to_string(integrator) << ": " << name << " and " << other->second;
    }
  }
}

TEST(StateHash, SeesWhichOfTwoEqualBodiesIsHeld) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.bodies = {make_block("one", BodyKind::rigid, "a", 2, {0, 0, 0}, Vec3::Zero()),
                  make_block("two", BodyKind::rigid, "a", 2, {1, 0, 0}, Vec3::Zero())};
  Simulation of_one = make_simulation(scene);
  Simulation of_two = make_simulation(scene);
  ASSERT_TRUE(grab(kHand, "one", 0, {0, 1, 0})(of_one).ok());
  ASSERT_TRUE(grab(kHand, "two", 0, {0, 1, 0})(of_two).ok());
  EXPECT_NE(of_one.state_hash(), of_two.state_hash());
}

TEST(StateHash, IsThatOfTheSnapshotThatIsRestored) {
  for (const IntegratorId integrator : kIntegrators) {
    for (const auto& [name, command] : kChanges) {
      Simulation simulation = make_run(integrator);
      ASSERT_TRUE(command(simulation).ok()) << name;
      const std::uint64_t hash = simulation.state_hash();
      const Snapshot snapshot = simulation.snapshot();
      simulation.advance(3);
      EXPECT_NE(simulation.state_hash(), hash) << name;
      simulation.restore(snapshot);
      EXPECT_EQ(simulation.state_hash(), hash) << to_string(integrator) << ": " << name;
    }
  }
}

/// Commands that leave everything unchanged except values that are kept from the last step.
const std::map<std::string, Command> kNoChanges = {
    {"nothing", [](Simulation&) { return Status(); }},
    {"the same gravity", [](Simulation& s) { return s.set_gravity(s.scene().gravity); }},
    {"an interface as it is", set_interface({{"a", "b"}, {500, 1}, {}})},
    {"a grab that ends", grab(kHand, "crate", 5, {0, 0, 0.5}) + end_grab(kHand)},
    {"a snapshot that is restored",
     [](Simulation& s) {
       s.restore(s.snapshot());
       return Status();
     }},
    {"a body that goes again",
     add_body(make_block("newcomer", BodyKind::rigid, "a", 2, {0, 0, 0.8}, Vec3::Zero())) +
         remove_body("newcomer")}};

// Velocity Verlet starts a step with the forces at the end of the last step. A command discards
// them. If this changes later bits, the hash must change too.
TEST(StateHash, EqualHashesHaveEqualFutures) {
  for (const IntegratorId integrator : kIntegrators) {
    std::map<std::uint64_t, std::uint64_t> later;
    for (const auto& [name, command] : kNoChanges) {
      Simulation simulation = make_run(integrator);
      ASSERT_TRUE(command(simulation).ok()) << name;
      const std::uint64_t now = simulation.state_hash();
      simulation.advance(100);
      const auto [known, is_new] = later.emplace(now, simulation.state_hash());
      EXPECT_EQ(known->second, simulation.state_hash()) << to_string(integrator) << ": " << name;
    }
    // With the other integrators, these commands have no effect.
    EXPECT_EQ(later.size(), integrator == IntegratorId::velocity_verlet ? 2U : 1U);
  }
}

}  // namespace
}  // namespace vat::test::state_hash_test
