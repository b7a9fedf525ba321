#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/support/shaken_vat.h"

// The hash covers all that the next steps start from: equal hashes have equal futures.

namespace vat::state_hash_test {
namespace {

using namespace test;

constexpr std::uint32_t kSteps = 25;
constexpr std::uint64_t kHand = 7;

using Command = std::function<Status(Simulation&)>;

Simulation make_run(IntegratorId integrator) {
  Simulation simulation = make_simulation(make_shaken_vat(integrator));
  EXPECT_TRUE(simulation.advance(kSteps).events.empty());
  return simulation;
}

Status grab(Simulation& simulation, std::uint64_t hand, std::size_t body, Index particle,
            const Vec3& target) {
  return simulation.grab_start(hand, simulation.bodies()[body].id, particle, target);
}

/// Each does something that shows later.
const std::map<std::string, Command> kChanges = {
    {"gravity",
     [](Simulation& s) {
       return s.set_gravity({0, 0, -9.8});
     }},
    {"grab of a deformable body",
     [](Simulation& s) {
       return grab(s, kHand, 1, 5, {0, 0, 0.5});
     }},
    {"grab of another particle",
     [](Simulation& s) {
       return grab(s, kHand, 1, 6, {0, 0, 0.5});
     }},
    {"grab of its middle, all of it in reach",
     [](Simulation& s) {
       return grab(s, kHand, 1, 13, {0, 0, 0.5});
     }},
    {"grab of a face, all of it in reach",
     [](Simulation& s) {
       return grab(s, kHand, 1, 4, {0, 0, 0.5});
     }},
    {"grab of a rigid body",
     [](Simulation& s) {
       return grab(s, kHand, 2, 5, {0, 0, 0.5});
     }},
    {"grab with another target",
     [](Simulation& s) {
       return grab(s, kHand, 2, 5, {0, 0, 0.6});
     }},
    {"grab that is moved",
     [](Simulation& s) {
       EXPECT_TRUE(grab(s, kHand, 2, 5, {0, 0, 0.5}).ok());
       return s.grab_move(kHand, {0, 0.1, 0.5});
     }},
    {"two grabs",
     [](Simulation& s) {
       EXPECT_TRUE(grab(s, kHand, 2, 5, {0, 0, 0.5}).ok());
       return grab(s, kHand + 1, 1, 5, {0, 0, 0.5});
     }},
    {"force",
     [](Simulation& s) {
       return s.apply_force(s.bodies()[2].id, {1, 0, 0}, 0.01);
     }},
    {"longer force of the same strength",
     [](Simulation& s) {
       return s.apply_force(s.bodies()[2].id, {1, 0, 0}, 0.011);
     }},
    {"stronger force",
     [](Simulation& s) {
       return s.apply_force(s.bodies()[2].id, {2, 0, 0}, 0.01);
     }},
    {"force on another body", [](Simulation& s) {
       return s.apply_force(s.bodies()[1].id, {1, 0, 0}, 0.01);
     }}};

TEST(StateHash, SeesWhatEveryCommandSets) {
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
  ASSERT_TRUE(grab(of_one, kHand, 0, 0, {0, 1, 0}).ok());
  ASSERT_TRUE(grab(of_two, kHand, 1, 0, {0, 1, 0}).ok());
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

/// Each leaves everything as it was, but for what is kept from the last step.
const std::map<std::string, Command> kNoChanges = {
    {"nothing", [](Simulation&) { return Status(); }},
    {"the same gravity", [](Simulation& s) { return s.set_gravity(s.scene().gravity); }},
    {"an interface as it is",
     [](Simulation& s) {
       return s.set_interface({{"a", "b"}, {500, 1}, {}});
     }},
    {"a grab that ends",
     [](Simulation& s) {
       EXPECT_TRUE(grab(s, kHand, 2, 5, {0, 0, 0.5}).ok());
       return s.grab_end(kHand);
     }},
    {"a snapshot that is restored",
     [](Simulation& s) {
       s.restore(s.snapshot());
       return Status();
     }},
    {"a body that goes again", [](Simulation& s) {
       const auto newcomer =
           make_block("newcomer", BodyKind::rigid, "a", 2, {0, 0, 0.8}, Vec3::Zero());
       return s.remove_body(s.add_body(newcomer).value());
     }}};

// Velocity Verlet opens a step with the forces that closed the last one. A command drops them, and
// where that changes the bits to come, the hash must say so.
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
    // With the other methods no command leaves a trace.
    EXPECT_EQ(later.size(), integrator == IntegratorId::velocity_verlet ? 2U : 1U);
  }
}

}  // namespace
}  // namespace vat::state_hash_test
