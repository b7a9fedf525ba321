#include <gtest/gtest.h>

#include "tests/core/support/resting_scenes.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/saved_bits.h"
#include "tests/support/shaken_vat.h"

// Snapshots that are saved while the state contains more than positions and velocities.

namespace vat::test::saved_simulation_test {
namespace {

TEST(SavedSimulation, ContinuesWithEveryIntegratorAndStepControl) {
  std::vector<Scene> scenes;
  for (const IntegratorId integrator : kIntegrators) scenes.push_back(make_shaken_vat(integrator));
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    scenes.push_back(make_shaken_vat(IntegratorId::velocity_verlet, 2e-3));
    scenes.back().numerics.control = control;
  }
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(testing::Message() << to_string(scene.numerics.integrator) << ' '
                                    << to_string(scene.numerics.control));
    Simulation simulation = make_simulation(scene);
    expect_goes_on(simulation, 20);
    simulation.advance(100);
    expect_goes_on(simulation, 50);
  }
}

TEST(SavedSimulation, HasGrabsAndForcesOfUsers) {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 30);
  const std::vector<BodyView> bodies = simulation.bodies();
  ASSERT_TRUE(simulation.grab_start(7, bodies[1].id, 5, {0.1, 0.1, 0.4}).ok());
  ASSERT_TRUE(simulation.grab_start(1ULL << 40, bodies[0].id, 0, {0, 0.1, 0.1}).ok());
  ASSERT_TRUE(simulation.apply_force(bodies[2].id, {5, 0, -3}, 0.02).ok());
  ASSERT_TRUE(simulation.set_gravity({3, 1, -5}).ok());
  expect_goes_on(simulation, 5);  // the force is still active
  expect_goes_on(simulation, 40, [n = 0](Simulation& each) mutable {
    ASSERT_TRUE(each.grab_move(7, {0.1, 0, 0.3 + 0.001 * (n++ / 2)}).ok());
  });
}

BodyDescription make_newcomer(BodyKind kind, Real height) {
  return make_block("new " + std::to_string(height), kind, "b", 3, {0.05, 0, height}, Vec3::Zero());
}

TEST(SavedSimulation, HoldsBodiesThatCameAndWent) {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 20);
  ASSERT_TRUE(simulation.add_body(make_newcomer(BodyKind::deformable, 0.5)).ok());
  const BodyId second = simulation.add_body(make_newcomer(BodyKind::liquid, 0.7)).value();
  ASSERT_TRUE(simulation.remove_body(simulation.find_body("crate").value()).ok());
  ASSERT_TRUE(simulation.set_interface({{"a", "b"}, {900, 0.2}, 0.07}).ok());
  simulation.advance(20);
  expect_goes_on(simulation, 20);
  // The removed body's id is not reused.
  ASSERT_TRUE(simulation.remove_body(second).ok());
  auto loaded = Simulation::load(simulation.snapshot().to_bytes());
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded.value().add_body(make_newcomer(BodyKind::liquid, 0.7)).value(), second + 1);
}

TEST(SavedSimulation, ContinuesAfterUndoneSteps) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {1000, 0, 0};
  scene.bodies = {make_block("fast", BodyKind::liquid, "a", 1, {0, 0, 0}, {45, 0, 0}),
                  make_block("other", BodyKind::rigid, "b", 1, {9, 9, 9}, Vec3::Zero())};
  Simulation simulation = make_simulation(scene);
  std::uint64_t undone = 0;
  for (int step = 0; step < 40; ++step) {
    undone += simulation.advance(1).undone_steps;
    if (step % 10 == 9) expect_goes_on(simulation, 3);
  }
  EXPECT_GT(undone, 0U);
}

TEST(SavedSimulation, HasSleepingBodies) {
  Simulation simulation = make_advanced(make_struck_stack(),
                                        60);  // contacts, and checks of bodies that may fall asleep
  expect_goes_on(simulation, 10);
  simulation.advance(100);
  ASSERT_EQ(simulation.sleeping_body_count(), 3U);
  expect_goes_on(simulation, 20);  // the stack wakes
  ASSERT_EQ(simulation.sleeping_body_count(), 1U);
  expect_goes_on(simulation, 100);
}

TEST(SavedSimulation, HoldsLiquidThatSleeps) {
  for (const PressureSolver solver : {PressureSolver::tait, PressureSolver::incompressible}) {
    SCOPED_TRACE(to_string(solver));
    Simulation simulation = make_simulation(make_resting_pool(solver));
    advance_to_sleep(simulation, "water", kPebbleRelease);
    ASSERT_TRUE(is_asleep(simulation, "water"));
    expect_goes_on(simulation, 3);
    while (simulation.time() < kPebbleSplash - 0.1) simulation.advance(3);
    expect_goes_on(simulation, 20);
    ASSERT_FALSE(is_asleep(simulation, "water"));
    expect_goes_on(simulation, 3);
  }
}

// The damping of an incompressible liquid uses the gravity at its compilation.
TEST(SavedSimulation, KeepsTheDampingOfAnEarlierGravity) {
  Scene scene = make_resting_pool(PressureSolver::incompressible);
  scene.sleeping.reset();
  scene.materials[1].liquid->viscosity = 400;
  Simulation simulation = make_advanced(scene, 9);
  ASSERT_TRUE(simulation.set_gravity({0, 0, -900}).ok());
  expect_goes_on(simulation, 3);
}

TEST(SavedSimulation, HoldsAMomentOfAFlowAndOfMelting) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2e-3);
  scene.numerics.tick = 0.02;
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -10};
  scene.materials = {make_liquid("water", 1000, {.stiffness = 100, .support_radius = 0.125}),
                     make_material("ice", 900)};
  BodyDescription pool{"pool", BodyKind::liquid, "water",
                       BoxShape{{0.5, 0.5, 0.03}, {0.2, 0.2, 0.05}}, 0.05};
  BodyDescription ice = make_body("ice", BodyKind::deformable, "ice",
                                  make_particles(make_lattice(3, 3, 3, 0.05), 0.1), 0.025);
  ice.springs = join_near(make_lattice(3, 3, 3, 0.05), 0.06, {500, 1});
  ice.position = {0.9, 0.5, 0.1};
  ice.melting = Melting{"water", 0.3};
  scene.bodies = {pool, ice};
  scene.vat = Vat{{0, 0, 0}, {1.5, 1, 1}, false, {}, {}};
  scene.emitters = {{.name = "tap",
                     .body = "pool",
                     .position = {0.2, 0.5, 0.5},
                     .size = {{0.15, 0.15}},
                     .speed = 0.75,
                     .most_particles = 5000}};
  scene.drains = {{"hole", {0.1, 0.4, 0}, {0.3, 0.6, 0.06}}};
  Simulation simulation = make_simulation(scene);
  for (int n = 0; n < 6; ++n) {
    simulation.advance(37);  // within a tick and between layers
    expect_goes_on(simulation, 4);
  }
  EXPECT_GT(simulation.diagnostics().drained_particles, 0U);
  EXPECT_EQ(simulation.bodies()[1].kind, BodyKind::liquid);
  ASSERT_TRUE(simulation.set_emitter("tap", false).ok());
  expect_goes_on(simulation, 4);
}

TEST(SavedSimulation, HoldsTheHashOfItsMoment) {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::heun), 10);
  const Snapshot snapshot = simulation.snapshot();
  const std::uint64_t hash = simulation.state_hash();
  simulation.advance(10);
  EXPECT_EQ(snapshot.state_hash(), hash);
  EXPECT_NE(simulation.state_hash(), hash);
  EXPECT_EQ(Simulation::load(snapshot.to_bytes()).value().state_hash(), hash);
}

// A session that returns to its scene after a restart does the same.
TEST(SavedSimulation, GoesBackToAStartMadeAnew) {
  const Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
  Simulation simulation = make_simulation(scene);
  const Snapshot start = simulation.snapshot();
  simulation.advance(10);
  ASSERT_TRUE(simulation.add_body(make_newcomer(BodyKind::liquid, 0.7)).ok());
  Simulation loaded = Simulation::load(simulation.snapshot().to_bytes()).value();
  loaded.restore(make_simulation(scene).snapshot());
  simulation.restore(start);
  EXPECT_EQ(loaded.state_hash(), simulation.state_hash());
  EXPECT_EQ(loaded.add_body(make_newcomer(BodyKind::liquid, 0.7)).value(),
            simulation.add_body(make_newcomer(BodyKind::liquid, 0.7)).value());
  loaded.advance(20);
  simulation.advance(20);
  EXPECT_EQ(loaded.state_hash(), simulation.state_hash());
}

}  // namespace
}  // namespace vat::test::saved_simulation_test
