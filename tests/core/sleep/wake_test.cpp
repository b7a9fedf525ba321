#include <gtest/gtest.h>

#include <functional>

#include "tests/core/support/resting_scenes.h"
#include "tests/support/commands.h"

// Events that wake sleeping bodies.

namespace vat::test::wake_test {
namespace {

/// Returns a simulation with sleeping bodies. A marble, if there is one, falls on the first of
/// them.
Simulation make_sleeping(const Scene& scene, const std::string& name) {
  Simulation simulation = make_simulation(scene);
  advance_to_sleep(simulation, name, 2);
  EXPECT_TRUE(is_asleep(simulation, name));
  return simulation;
}

Scene make_two_crates() {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("one", 0.0), make_crate("two", 5.0)};
  return scene;
}

TEST(Wake, NoContactLeavesSleepers) {
  for (const bool is_local : {false, true}) {
    Scene scene = make_resting_scene();
    if (is_local) {
      scene.default_interface = {20000, 40, 0.3};
      scene.numerics = {IntegratorId::velocity_verlet, 4e-3, 0.016, StepControl::local};
      scene.sleeping->speed = 0.02;
    }
    scene.bodies = {make_crate("crate", 0.0), make_marble("marble", {0.05, 0.02, 6})};
    Simulation simulation = make_simulation(scene);
    bool slept = false;
    bool touched = false;
    while (simulation.time() < 2) {
      simulation.advance(1);
      const auto bodies = simulation.bodies();
      slept = slept || bodies[0].is_asleep;
      if (distance_of(bodies[0], bodies[1]) > 2 * kRestRadius) continue;
      ASSERT_FALSE(bodies[0].is_asleep);
      touched = true;
    }
    EXPECT_TRUE(slept);
    EXPECT_TRUE(touched);
  }
}

/// Sleep removes at most its threshold speed. Positions therefore differ by that speed times the
/// elapsed time, and velocities by the speed. The impact is central, so differences do not grow.
TEST(Wake, AnImpactIsThatWithoutSleep) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", 0.0), make_marble("marble", {0, 0, 4})};
  Scene awake = scene;
  awake.sleeping.reset();
  Simulation a = make_simulation(scene);
  Simulation b = make_simulation(awake);
  Real slept_at = 0;
  for (int n = 0; n < 300; ++n) {
    a.advance(1);
    b.advance(1);
    if (slept_at == 0 && is_asleep(a, "crate")) slept_at = a.time() - a.step_size();
    const Real bound = scene.sleeping->speed * (a.time() - slept_at);
    for (std::size_t body = 0; body < 2; ++body) {
      ASSERT_LE((position_of(a, body) - position_of(b, body)).norm(), bound) << n;
      ASSERT_LE((velocity_of(a, body) - velocity_of(b, body)).norm(), scene.sleeping->speed) << n;
    }
  }
  EXPECT_GT(slept_at, 0);
  EXPECT_LT(position_of(b, 1).z(), 0.5);  // it hit the crate
}

TEST(Wake, OneIslandAndNotTheNext) {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("low", 0.0), make_crate("high", {0, 0, kCrateRest + kCrateEdge}),
                  make_crate("far", 5.0), make_marble("marble", {0, 0, 6})};
  Simulation simulation = make_sleeping(scene, "low");
  ASSERT_TRUE(is_asleep(simulation, "high"));
  while (simulation.time() < 2 && is_asleep(simulation, "high")) simulation.advance(1);
  EXPECT_LT(simulation.time(), 1.2);  // it falls for 1.05 s
  EXPECT_FALSE(is_asleep(simulation, "low"));
  EXPECT_TRUE(is_asleep(simulation, "far"));
  advance_to_sleep(simulation, "low", 6);
  EXPECT_TRUE(is_asleep(simulation, "low"));
  EXPECT_EQ(simulation.diagnostics().sleeping_bodies, 4U);
}

TEST(Wake, AcrossTheSeamOfAPeriodicWorld) {
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.vat.reset();
  scene.periodic = Periodicity{{-2, -2, -2}, {2, 2, 2}, {true, false, false}};
  scene.bodies = {make_crate("crate", {1.85, 0, 0}), make_marble("marble", {-1.4, 0, 0})};
  scene.bodies[1].velocity = {-0.3, 0, 0};
  Simulation simulation = make_sleeping(scene, "crate");
  while (simulation.time() < 2 && velocity_of(simulation, 1).x() == -0.3) {
    ASSERT_GE(position_of(simulation, 1).x(), -2.05 + 2 * kRestRadius - 1e-9);
    simulation.advance(1);
  }
  EXPECT_FALSE(is_asleep(simulation, "crate"));
  EXPECT_LT(velocity_of(simulation, 0).x(), 0);
}

TEST(Wake, ByABodyThatFallsIntoALiquid) {
  for (const PressureSolver solver : {PressureSolver::tait, PressureSolver::incompressible}) {
    Simulation simulation = make_simulation(make_resting_pool(solver));
    bool slept = false;
    while (simulation.time() < kPebbleSplash) {
      simulation.advance(1);
      const auto bodies = simulation.bodies();
      slept = slept || bodies[0].is_asleep;
      if (distance_of(bodies[0], bodies[2]) < kPoolSupport) {
        ASSERT_FALSE(bodies[0].is_asleep);
      }
      ASSERT_EQ(bodies[0].is_asleep, bodies[1].is_asleep);
    }
    EXPECT_TRUE(slept);
    EXPECT_FALSE(is_asleep(simulation, "water"));
    EXPECT_LT(position_of(simulation, 2).z(), 0.7);
  }
}

/// The guard limits the step of an awake body to the distance at which it detects sleeping bodies.
TEST(Wake, TheGuardMindsSleepers) {
  Scene scene = make_resting_scene();
  scene.gravity.setZero();
  scene.vat.reset();
  scene.bodies = {make_crate("crate", {0, 0, 0}), make_marble("marble", {100, 0, 0})};
  scene.bodies[1].velocity = {-30, 0, 0};  // 0.125 m per step; the reach is 0.1 m
  Simulation simulation = make_simulation(scene);
  EXPECT_FALSE(simulation.advance(120).events.empty());
  ASSERT_TRUE(is_asleep(simulation, "crate"));
  EXPECT_FALSE(simulation.advance(1).events.empty());
  while (simulation.time() < 3.4) simulation.advance(1);
  EXPECT_FALSE(is_asleep(simulation, "crate"));
  // The bodies share the momentum of 15 kg m/s, without rebound.
  EXPECT_NEAR(velocity_of(simulation, 0, 13).x(), -15 / 3.2, 1e-9);
}

TEST(Wake, ByLiquidThatGoesDownADrain) {
  Scene scene = make_resting_scene();
  scene.default_interface = {1000, 20};
  scene.interfaces = {{{"wood", "vat"}, {.friction = 0.5, .law = InterfaceLaw::projection}, {}}};
  scene.materials.push_back(make_liquid("water", 1000, {10, 1, 0.2}));
  BodyDescription water = make_body("water", BodyKind::liquid, "water",
                                    make_particles({{0, 0, 3}, {0.1, 0, 3}}, 1), kRestRadius);
  scene.bodies = {water, make_crate("crate", 5.0)};
  scene.drains = {{"drain", {-1, -1, 0}, {1, 1, 1}}};
  Simulation simulation = make_simulation(scene);
  advance_to_sleep(simulation, "crate", 2);
  ASSERT_TRUE(is_asleep(simulation, "crate"));
  ASSERT_EQ(simulation.bodies()[0].positions.size(), 2U);
  while (simulation.time() < 1 && simulation.diagnostics().drained_particles == 0) {
    simulation.advance(1);
  }
  EXPECT_EQ(simulation.diagnostics().drained_particles, 2U);
  EXPECT_FALSE(is_asleep(simulation, "crate"));
  EXPECT_EQ(simulation.bodies()[0].positions.size(), 0U);
  EXPECT_NEAR(position_of(simulation, 1, 13).z(), kCrateRest, 1e-9);
}

using Commands = std::map<std::string, Command>;

TEST(Wake, ByEveryCommandThatMayMoveSomething) {
  const Commands commands = {
      {"gravity", set_gravity({0, 0, -5})},
      {"interface",
       set_interface({{"wood", "wood"}, {.friction = 0.1, .law = InterfaceLaw::projection}, {}})},
      {"add", add_body(make_crate("new", {0, 9, kCrateRest}))},
      {"remove", remove_body("two")},
      {"force", apply_force("one", {1, 0, 0}, 0.1)},
      {"grab", grab(1, "one", 0, {0, 0, 1})}};
  for (const auto& [name, command] : commands) {
    Simulation simulation = make_sleeping(make_two_crates(), "one");
    ASSERT_TRUE(command(simulation).ok()) << name;
    EXPECT_EQ(simulation.diagnostics().sleeping_bodies, 0U) << name;
    EXPECT_FALSE(is_asleep(simulation, "one")) << name;
    EXPECT_GT(simulation.advance(4).steps, 0U) << name;
    // It does not sleep at the next check, although it was slow before.
    simulation.advance(4);
    EXPECT_FALSE(is_asleep(simulation, "one")) << name;
  }
}

TEST(Wake, NotByAnAppearance) {
  Simulation simulation = make_sleeping(make_two_crates(), "one");
  const std::uint64_t before = simulation.state_hash();
  Material wood = simulation.scene().materials[0];
  wood.appearance.opacity = 0.5;
  ASSERT_TRUE(simulation.set_material(wood).ok());
  EXPECT_EQ(simulation.state_hash(), before);
  EXPECT_TRUE(is_asleep(simulation, "one"));
  EXPECT_EQ(simulation.scene().materials[0], wood);
  ASSERT_TRUE(simulation.apply_force(id_of(simulation, "one"), {1, 0, 0}, 0.1).ok());
  EXPECT_FALSE(is_asleep(simulation, "one"));
  EXPECT_EQ(simulation.scene().materials[0], wood);
}

TEST(Wake, ACommandBeginsTheTimeOfRestAnew) {
  const Scene scene = make_two_crates();
  Simulation simulation = make_simulation(scene);
  advance_to_sleep(simulation, "one", 2);
  Simulation disturbed = make_advanced(scene, 40);
  ASSERT_TRUE(disturbed.set_gravity({0, 0, -9.8}).ok());
  const Real since = disturbed.time();
  advance_to_sleep(disturbed, "one", 2);
  EXPECT_TRUE(is_asleep(disturbed, "one"));
  EXPECT_GE(disturbed.time() - since, scene.sleeping->after);
  EXPECT_GT(disturbed.time(), simulation.time());
}

TEST(Wake, ByAGrabItFollowsIt) {
  Simulation simulation = make_sleeping(make_two_crates(), "two");
  const BodyId two = simulation.find_body("two").value();
  ASSERT_TRUE(simulation.grab_start(1, two, 13, {5, 0, 1}).ok());
  simulation.advance(480);
  EXPECT_NEAR(position_of(simulation, 1, 13).z(), 1, 0.1);  // it hangs slightly lower
  EXPECT_TRUE(is_asleep(simulation, "one"));
}

TEST(Wake, NotByCommandsThatFail) {
  const Commands commands = {
      {"gravity", set_gravity({0, 0, 1e9})},
      {"interface", set_interface({{"wood", "iron"}, {}, {}})},
      {"add", add_body(make_crate("one", {0, 9, kCrateRest}))},
      {"remove", remove_body("absent")},
      {"melt", [](Simulation& s) { return s.melt_body(id_of(s, "one"), "wood"); }},
      {"emitter", [](Simulation& s) { return s.set_emitter("tap", true); }},
      {"force", apply_force("one", {1, 0, 0}, -1)},
      {"grab", grab(1, "one", 99, {0, 0, 1})},
      {"move", move_grab(1, {0, 0, 1})},
      {"end", end_grab(1)}};
  Simulation simulation = make_sleeping(make_two_crates(), "one");
  const std::uint64_t before = simulation.state_hash();
  for (const auto& [name, command] : commands) {
    ASSERT_FALSE(command(simulation).ok()) << name;
    EXPECT_EQ(simulation.diagnostics().sleeping_bodies, 2U) << name;
    EXPECT_EQ(simulation.state_hash(), before) << name;
  }
}

}  // namespace
}  // namespace vat::test::wake_test
